//! Pictures with closed forms.

use std::f64::consts::PI;

use arty::integrator::{Settings, Technique};
use arty::math::{Rgb, Vec3};
use arty::scene::{Scene, SceneDescription, Specular};
use glam::DVec3;

use super::Context;
use crate::limits::sweep::{Point, Series, Sweep, decades};
use judge::scenes::{add, camera, ceiling, changed, empty, floor, grey, hollow_ball, point_light, rectangle};
use verdict::error::Result;

/// Largest relative error that is right.
const LIMIT: f64 = 1e-3;

const ERROR: &str = "relative error";

/// Measures one scene against its true mean.
fn point(
    context: &Context<'_>,
    x: f64,
    scene: &SceneDescription,
    settings: Settings,
    truth: f64,
) -> Result<Point> {
    let measured = context.measure(scene, settings, context.effort)?;
    Ok(Point {
        x,
        y: measured.error(truth),
        noise: measured.noise(truth),
        anomalies: measured.non_finite + measured.negative,
        note: Scene::new(scene).warnings().join("; "),
    })
}

/// One curve for each technique.
fn curves(
    context: &Context<'_>,
    techniques: &[Technique],
    xs: impl Iterator<Item = f64> + Clone,
    scene: impl Fn(f64) -> (SceneDescription, f64),
) -> Result<Vec<Series>> {
    let curve = |&technique: &Technique| {
        let settings = Settings { technique, max_bounces: 1 };
        let point = |x| {
            let (scene, truth) = scene(x);
            point(context, x, &scene, settings, truth)
        };
        Ok(Series { name: technique.to_string(), points: xs.clone().map(point).collect::<Result<_>>()? })
    };
    techniques.iter().map(curve).collect()
}

/// Radiance of a floor of reflectance ½ below the centre of a parallel square light.
///
/// E = 4 · L · X/√(1+X²) · atan(X/√(1+X²)), with X = side / (2 · height) (Howell's catalogue, B-4).
fn below_square(height: f64, side: f64, radiance: f64) -> f64 {
    let x = 0.5 * side / height;
    let share = x / x.hypot(1.0);
    0.5 / PI * 4.0 * radiance * share * share.atan()
}

/// A floor below a square light of this height, side and radiance, and the radiance that the camera sees.
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
pub(super) fn scale(context: &Context<'_>) -> Result<Sweep> {
    let (base, truth) = square_over_floor(2.0, 1.0, 10.0);
    Ok(Sweep {
        name: "scale",
        about: "A floor below a square light, scaled as a whole.",
        axis: "scale of the scene",
        measure: ERROR,
        limit: LIMIT,
        series: curves(context, &[Technique::Nee, Technique::Mis], decades(-24, 24), |scale| {
            (changed(&base, scale, DVec3::ZERO, 1.0), truth)
        })?,
    })
}

/// Distance of the whole scene from the origin.
pub(super) fn offset(context: &Context<'_>) -> Result<Sweep> {
    let (mut base, truth) = square_over_floor(2.0, 1.0, 10.0);
    // A wide enough view that rounded coordinates do not decide where the camera looks.
    base.camera = camera(DVec3::new(0.3, 1.0, 0.5), DVec3::ZERO, 1.0);
    Ok(Sweep {
        name: "offset",
        about: "The same scene, 16 units wide, moved away from the origin.",
        axis: "distance from the origin in units",
        measure: ERROR,
        limit: LIMIT,
        series: curves(context, &[Technique::Nee, Technique::Mis], decades(0, 10), |distance| {
            (changed(&base, 1.0, distance * DVec3::new(0.6, 0.48, 0.64), 1.0), truth)
        })?,
    })
}

/// Distance of a light from what it illuminates.
pub(super) fn light_distance(context: &Context<'_>) -> Result<Sweep> {
    let scene = |height: f64| square_over_floor(height, 1.0, height.max(1.0).powi(2));
    let mut series = curves(context, &[Technique::Mis], decades(-20, 18), scene)?;
    series.extend(curves(context, &[Technique::Nee], decades(0, 18), scene)?);
    Ok(Sweep {
        name: "light-distance",
        about: "A square light of side 1, very near to very far. Below 1, the variance of `nee` grows without bound.",
        axis: "distance of the light / its side",
        measure: ERROR,
        limit: LIMIT,
        series,
    })
}

/// Side of a light.
pub(super) fn light_size(context: &Context<'_>) -> Result<Sweep> {
    let scene = |side: f64| square_over_floor(1.0, side, side.min(1.0).powi(-2));
    let mut series = curves(context, &[Technique::Mis], decades(-22, 18), scene)?;
    series.extend(curves(context, &[Technique::Nee], decades(-22, 0), scene)?);
    Ok(Sweep {
        name: "light-size",
        about: "A square light at distance 1, tiny to huge. Above 1, the variance of `nee` grows with the area.",
        axis: "side of the light / its distance",
        measure: ERROR,
        limit: LIMIT,
        series,
    })
}

/// Radiance of a light.
pub(super) fn radiance(context: &Context<'_>) -> Result<Sweep> {
    Ok(Sweep {
        name: "radiance",
        about: "A floor below a square light, very dim to very bright.",
        axis: "radiance of the light",
        measure: ERROR,
        limit: LIMIT,
        series: curves(context, &[Technique::Nee, Technique::Mis], decades(-44, 38), |radiance| {
            square_over_floor(2.0, 1.0, radiance)
        })?,
    })
}

/// Uniform light from all directions.
fn surroundings() -> SceneDescription {
    let mut scene = empty();
    add(&mut scene, &hollow_ball(2.0, 3), grey(0.0, 1.0));
    scene
}

/// Exponent of a Phong lobe.
pub(super) fn exponent(context: &Context<'_>) -> Result<Sweep> {
    let mut base = surroundings();
    let lobe = |exponent: f64| Specular::Phong { reflectance: Rgb::gray(0.5), exponent: exponent as f32 };
    let plate = rectangle(DVec3::new(-0.5, -0.5, 0.0), DVec3::X, DVec3::Y);
    add(&mut base, &plate, grey(0.0, 0.0));
    base.camera = camera(DVec3::Z, DVec3::ZERO, 0.01);
    Ok(Sweep {
        name: "exponent",
        about: "A Phong lobe in uniform light, seen along the normal: it reflects ks.",
        axis: "exponent",
        measure: ERROR,
        limit: LIMIT,
        series: curves(context, &[Technique::Bsdf, Technique::Mis], decades(0, 38), |exponent| {
            let mut scene = base.clone();
            scene.materials[1].specular = lobe(exponent);
            (scene, 0.5)
        })?,
    })
}

/// Index of refraction.
pub(super) fn glass_index(context: &Context<'_>) -> Result<Sweep> {
    let mut base = surroundings();
    let plate = rectangle(DVec3::new(-0.5, -0.5, 0.0), DVec3::X, DVec3::Y);
    add(&mut base, &plate, grey(0.0, 0.0));
    base.camera = camera(DVec3::Z, DVec3::ZERO, 0.01);
    Ok(Sweep {
        name: "glass-index",
        about: "A glass surface in uniform light, seen along the normal: R + (1 − R) / n², R = ((n − 1) / (n + 1))².",
        axis: "index of refraction minus 1",
        measure: ERROR,
        limit: LIMIT,
        series: curves(context, &[Technique::Bsdf, Technique::Mis], decades(-9, 19), |excess| {
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

/// The inside of a grey sphere of radius 2 that emits radiance 1, subdivided n times; every triangle is a light.
pub(super) fn furnace(subdivisions: u32, reflectance: f32) -> SceneDescription {
    let mut scene = empty();
    add(&mut scene, &hollow_ball(2.0, subdivisions), grey(reflectance, 1.0));
    scene.camera = camera(DVec3::new(0.3, 0.2, 0.4), DVec3::new(-0.6, -0.3, -1.0), 70.0);
    scene
}

/// A floor below this many point lights, which share a fixed power.
pub(super) fn floor_below_points(count: usize) -> SceneDescription {
    let mut scene = empty();
    add(&mut scene, &floor(0.0, 16.0), grey(0.5, 0.0));
    let power = Rgb::gray((16.0 * PI / count as f64) as f32);
    scene.lights = vec![point_light(2.0 * Vec3::Y, power); count];
    scene
}
