//! Pictures with closed forms, rendered with the solution.

use std::f64::consts::PI;

use arty::integrator::{Settings, Technique};
use arty::math::Rgb;
use arty::scene::{LightDescription, Scene, SceneDescription, Specular};
use glam::DVec3;

use crate::limits::sweep::{Point, Series, Sweep, decades};
use harness::build::SubmissionProgram;
use harness::host_process::HostProcess;
use judge::extreme::build::{add, camera, ceiling, changed, empty, floor, grey, hollow_ball, rectangle};
use judge::extreme::measure::{Effort, measure};
use verdict::error::{Error, Result};

/// What is still right: a thousandth, which is what checks of means tolerate.
const LIMIT: f64 = 1e-3;

const ERROR: &str = "relative error";

/// A program that renders the points of sweeps.
pub struct Renderer<'a> {
    program: &'a SubmissionProgram,
    seed: u64,
    effort: Effort,
}

impl<'a> Renderer<'a> {
    /// Renders with a program, from a seed.
    pub fn new(program: &'a SubmissionProgram, seed: u64, effort: Effort) -> Self {
        Self { program, seed, effort }
    }

    /// Measures one scene against what it should show.
    fn point(
        &self,
        x: f64,
        scene: &SceneDescription,
        technique: Technique,
        bounces: u32,
        truth: f64,
    ) -> Result<Point> {
        // What the scene's own builder says of it.
        let note = Scene::new(scene).warnings().join("; ");
        let settings = Settings { technique, max_bounces: bounces };
        let trouble = |fault| Error::Harness(format!("the solution at {x:e}: {fault}"));
        let mut process = HostProcess::start(self.program, rayon::current_num_threads())?;
        let scene = process.load(scene)?.map_err(trouble)?;
        let measured =
            measure(&mut process, scene, settings, [8, 8], self.effort, self.seed)?.map_err(trouble)?;
        Ok(Point {
            x,
            y: measured.error(truth),
            noise: measured.noise(truth),
            anomalies: measured.non_finite + measured.negative,
            note,
        })
    }

    /// A curve for each technique.
    fn series(
        &self,
        techniques: &[Technique],
        bounces: u32,
        xs: impl Iterator<Item = f64> + Clone,
        scene: impl Fn(f64) -> (SceneDescription, f64),
    ) -> Result<Vec<Series>> {
        let curve = |&technique: &Technique| {
            let point = |x| {
                let (scene, truth) = scene(x);
                self.point(x, &scene, technique, bounces, truth)
            };
            Ok(Series { name: technique.to_string(), points: xs.clone().map(point).collect::<Result<_>>()? })
        };
        techniques.iter().map(curve).collect()
    }
}

/// What a floor of reflectance ½ shows below the middle of a parallel square.
///
/// E = 4 · L · X/√(1+X²) · atan(X/√(1+X²)), X half the side divided by the height (Howell's catalogue, B-4).
fn below_square(height: f64, side: f64, radiance: f64) -> f64 {
    let x = 0.5 * side / height;
    let share = x / x.hypot(1.0);
    0.5 / PI * 4.0 * radiance * share * share.atan()
}

/// A floor and a square light of the given height, side and radiance above it.
fn square_over_floor(height: f64, side: f64, radiance: f64) -> (SceneDescription, f64) {
    let mut scene = empty();
    let size = 16.0 * height.max(1.0);
    add(&mut scene, &floor(0.0, size), grey(0.5, 0.0));
    add(&mut scene, &ceiling(height, side), grey(0.0, radiance as f32));
    if height < 1.0 {
        scene.camera = camera(height * DVec3::new(0.3, 0.4, 0.5), DVec3::ZERO, 0.01);
    }
    (scene, below_square(height, side, f64::from(radiance as f32)))
}

/// Size of the whole scene.
pub fn scale(renderer: &Renderer<'_>) -> Result<Sweep> {
    let (base, truth) = square_over_floor(2.0, 1.0, 10.0);
    Ok(Sweep {
        name: "scale",
        about: "A floor under a square light, everything made larger or smaller.",
        axis: "scale of the scene",
        measure: ERROR,
        limit: LIMIT,
        series: renderer.series(&[Technique::Nee, Technique::Mis], 1, decades(-24, 24), |scale| {
            (changed(&base, scale, DVec3::ZERO, 1.0), truth)
        })?,
    })
}

/// Distance of the whole scene from the origin.
pub fn offset(renderer: &Renderer<'_>) -> Result<Sweep> {
    let (mut base, truth) = square_over_floor(2.0, 1.0, 10.0);
    // Coordinates that are rounded must not decide where the camera looks.
    base.camera = camera(DVec3::new(0.3, 1.0, 0.5), DVec3::ZERO, 1.0);
    Ok(Sweep {
        name: "offset",
        about: "The same scene, 16 units large, moved away from the origin.",
        axis: "distance from the origin in units",
        measure: ERROR,
        limit: LIMIT,
        series: renderer.series(&[Technique::Nee, Technique::Mis], 1, decades(0, 10), |distance| {
            (changed(&base, 1.0, distance * DVec3::new(0.6, 0.48, 0.64), 1.0), truth)
        })?,
    })
}

/// Height of a light above what it lights.
pub fn light_distance(renderer: &Renderer<'_>) -> Result<Sweep> {
    let scene = |height: f64| square_over_floor(height, 1.0, height.max(1.0).powi(2));
    let mut series = renderer.series(&[Technique::Mis], 1, decades(-20, 18), scene)?;
    series.extend(renderer.series(&[Technique::Nee], 1, decades(0, 18), scene)?);
    Ok(Sweep {
        name: "light-distance",
        about: "A square light of side 1, very near and very far. Below 1, `nee` has a variance that grows without bounds.",
        axis: "distance of the light in its sides",
        measure: ERROR,
        limit: LIMIT,
        series,
    })
}

/// Side of a light.
pub fn light_size(renderer: &Renderer<'_>) -> Result<Sweep> {
    let scene = |side: f64| square_over_floor(1.0, side, side.min(1.0).powi(-2));
    let mut series = renderer.series(&[Technique::Mis], 1, decades(-22, 18), scene)?;
    series.extend(renderer.series(&[Technique::Nee], 1, decades(-22, 0), scene)?);
    Ok(Sweep {
        name: "light-size",
        about: "A square light at the distance 1, tiny and huge. Above 1, `nee` has a variance that grows with the area.",
        axis: "side of the light in its distances",
        measure: ERROR,
        limit: LIMIT,
        series,
    })
}

/// Radiance of a light.
pub fn radiance(renderer: &Renderer<'_>) -> Result<Sweep> {
    Ok(Sweep {
        name: "radiance",
        about: "A floor under a square light, dim and bright.",
        axis: "radiance of the light",
        measure: ERROR,
        limit: LIMIT,
        series: renderer.series(&[Technique::Nee, Technique::Mis], 1, decades(-44, 38), |radiance| {
            square_over_floor(2.0, 1.0, radiance)
        })?,
    })
}

/// Even light from all around.
fn surroundings() -> SceneDescription {
    let mut scene = empty();
    add(&mut scene, &hollow_ball(2.0, 3), grey(0.0, 1.0));
    scene
}

/// Exponent of a Phong lobe.
pub fn exponent(renderer: &Renderer<'_>) -> Result<Sweep> {
    let mut base = surroundings();
    let lobe = |exponent: f64| Specular::Phong { reflectance: Rgb::gray(0.5), exponent: exponent as f32 };
    let plate = rectangle(DVec3::new(-0.5, -0.5, 0.0), DVec3::X, DVec3::Y);
    add(&mut base, &plate, grey(0.0, 0.0));
    base.camera = camera(DVec3::Z, DVec3::ZERO, 0.01);
    Ok(Sweep {
        name: "exponent",
        about: "A Phong lobe in even light, seen along its normal: it reflects ks.",
        axis: "exponent",
        measure: ERROR,
        limit: LIMIT,
        series: renderer.series(&[Technique::Bsdf, Technique::Mis], 1, decades(0, 38), |exponent| {
            let mut scene = base.clone();
            scene.materials[1].specular = lobe(exponent);
            (scene, 0.5)
        })?,
    })
}

/// Index of refraction.
pub fn glass_index(renderer: &Renderer<'_>) -> Result<Sweep> {
    let mut base = surroundings();
    let plate = rectangle(DVec3::new(-0.5, -0.5, 0.0), DVec3::X, DVec3::Y);
    add(&mut base, &plate, grey(0.0, 0.0));
    base.camera = camera(DVec3::Z, DVec3::ZERO, 0.01);
    Ok(Sweep {
        name: "glass-index",
        about: "A surface of glass in even light, seen along its normal: R + (1 − R) / n², R = ((n − 1) / (n + 1))².",
        axis: "index of refraction minus 1",
        measure: ERROR,
        limit: LIMIT,
        series: renderer.series(&[Technique::Bsdf, Technique::Mis], 1, decades(-9, 19), |excess| {
            let mut scene = base.clone();
            let index = (1.0 + excess) as f32;
            let (reflectance, transmittance) = (Rgb::WHITE, Rgb::WHITE);
            scene.materials[1].specular = Specular::Glass { index, reflectance, transmittance };
            let n = f64::from(index);
            let reflected = ((n - 1.0) / (n + 1.0)).powi(2);
            (scene, reflected + (1.0 - reflected) / (n * n))
        })?,
    })
}

/// A grey ball that glows inside, with this many triangles, all of them lights.
pub(super) fn furnace(subdivisions: u32, reflectance: f32) -> SceneDescription {
    let mut scene = empty();
    add(&mut scene, &hollow_ball(2.0, subdivisions), grey(reflectance, 1.0));
    scene.camera = camera(DVec3::new(0.3, 0.2, 0.4), DVec3::new(-0.6, -0.3, -1.0), 70.0);
    scene
}

/// A floor below this many point lights that share one power.
pub(super) fn floor_below_points(count: usize) -> SceneDescription {
    let mut scene = empty();
    add(&mut scene, &floor(0.0, 16.0), grey(0.5, 0.0));
    let light = LightDescription::Point {
        position: arty::math::Vec3::new(0.0, 2.0, 0.0),
        power: Rgb::gray((16.0 * PI / count as f64) as f32),
    };
    scene.lights = vec![light; count];
    scene
}
