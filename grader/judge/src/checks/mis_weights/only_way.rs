//! Light that only one technique can find has weight 1.

use arty::integrator::Settings;
use arty::math::{Rgb, Vec3};
use arty::scene::LightDescription;
use harness::host_process::HostProcess;
use host::protocol::{ProbeJob, ScriptedBsdf, ScriptedLight, ScriptedScene};
use verdict::check::{OnlyWay, OnlyWayWeight};

use super::{NOISE, TOLERATED, mean_and_error};
use crate::scenes;
use harness::job::JobError;

/// Measured weights of light that only one technique can find.
pub(super) struct OnlyWayTest {
    /// The first case whose weight is not 1; `None` if all are right.
    pub(super) wrong: Option<OnlyWay>,
    /// The weights of all cases.
    pub(super) weights: Vec<OnlyWayWeight>,
}

/// Measures the weights of all cases.
pub(super) fn measure(
    process: &mut HostProcess,
    settings: Settings,
    samples: u64,
    seed: u64,
) -> Result<OnlyWayTest, JobError> {
    let mut test = OnlyWayTest { wrong: None, weights: Vec::new() };
    for light in OnlyWay::ALL {
        let scenes = vec![match light {
            OnlyWay::SeenByCamera => seen_by_camera(),
            OnlyWay::AfterDelta => after_delta(),
            OnlyWay::PointLight => point_light(),
        }];
        let paths = process.probe(&ProbeJob { settings, scenes, samples, seed, stratified: false })?;
        let read = mean_and_error(&paths[0]);
        let is_right = read.is_some_and(|(mean, error)| (mean - 1.0).abs() <= TOLERATED + NOISE * error);
        if !is_right {
            test.wrong.get_or_insert(light);
        }
        test.weights.push(OnlyWayWeight { light, weight: read.map(|(mean, _)| mean) });
    }
    Ok(test)
}

/// The camera looks at the light.
fn seen_by_camera() -> ScriptedScene {
    let mut scene = scene(None);
    scene.origin = Vec3::new(0.3, 0.0, 0.5);
    scene.direction = (LIGHT - scene.origin).normalize();
    scene
}

/// A delta distribution reflects towards the light with probability 1/4; with these densities, any weight other than 1
/// changes the result.
fn after_delta() -> ScriptedScene {
    let direction = LIGHT.normalize();
    let f = 0.25 / direction.z;
    scene(Some(ScriptedBsdf { target: LIGHT, f, pdf: 0.25, is_delta: true }))
}

/// A point light with f · I · cos / d² = 1, and a BSDF sample that hits nothing.
fn point_light() -> ScriptedScene {
    let mut scene =
        scene(Some(ScriptedBsdf { target: Vec3::new(-1.0, 0.5, 1.0), f: 0.5, pdf: 3.0, is_delta: false }));
    let (direction, squared) = (LIGHT.normalize(), LIGHT.length_squared());
    let intensity = squared / (0.5 * direction.z);
    scene.scene.lights = vec![LightDescription::Point {
        position: LIGHT,
        power: Rgb::gray(4.0 * std::f32::consts::PI * intensity),
    }];
    scene.lights.clear();
    scene
}

/// Center of the light.
const LIGHT: Vec3 = Vec3::new(1.0, 0.25, 1.0);

/// A surface in the plane z = 0 around the origin, and a light of radiance 1 that faces it.
fn scene(bsdf: Option<ScriptedBsdf>) -> ScriptedScene {
    let around = |middle: Vec3, up: f32| {
        [(0.2, 0.0), (-0.1, 0.15 * up), (-0.1, -0.15 * up)].map(|(x, y)| middle + Vec3::new(x, y, 0.0))
    };
    let mut scene = scenes::empty();
    let surface = around(Vec3::ZERO, 1.0).map(|corner| corner.as_dvec3());
    scenes::add(&mut scene, &[surface], scenes::grey(0.0, 0.0));
    scene.lights = vec![LightDescription::Triangle { vertices: around(LIGHT, -1.0), radiance: Rgb::WHITE }];
    ScriptedScene {
        scene,
        bsdfs: vec![bsdf],
        lights: vec![Some(ScriptedLight { point: LIGHT, pdf_area: 2.0 })],
        origin: Vec3::new(-0.2, 0.0, 1.0),
        direction: Vec3::new(0.2, 0.0, -1.0).normalize(),
    }
}
