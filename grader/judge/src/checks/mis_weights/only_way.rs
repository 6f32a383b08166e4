//! Light that only one technique can find has weight 1.

use arty::integrator::Settings;
use arty::math::{Frame, Rgb, Vec3};
use arty::scene::{LightDescription, Material};
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
            OnlyWay::AfterLight => after_light(),
        }];
        let paths = process.probe(&ProbeJob { settings, scenes, samples, seed, stratified: false })?;
        let read = mean_and_error(&paths[0]);
        let is_right = read.is_some_and(|(mean, error)| {
            let path_ended = light == OnlyWay::AfterLight && mean == 0.0;
            // That paths end at lights is a mistake, but not one of the weights.
            path_ended || (mean - 1.0).abs() <= TOLERATED + NOISE * error
        });
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
    scene(Some(uniform(LIGHT, f, 0.25, true)))
}

/// A point light with f · I · cos / d² = 1, and a BSDF sample that hits nothing.
fn point_light() -> ScriptedScene {
    let target = Vec3::new(-1.0, 0.5, 1.0);
    let mut scene = scene(Some(uniform(target, 0.5, 3.0, false)));
    let (direction, squared) = (LIGHT.normalize(), LIGHT.length_squared());
    let intensity = squared / (0.5 * direction.z);
    scene.scene.lights = vec![LightDescription::Point {
        position: LIGHT,
        power: Rgb::gray(4.0 * std::f32::consts::PI * intensity),
    }];
    scene.lights.clear();
    scene
}

/// A blue light that reflects, between the surface and a red light: the surface's BSDF samples hit the blue one, a delta
/// distribution there reflects towards the red one, and the surface is behind the latter. So red reaches the camera by one
/// path only.
fn after_light() -> ScriptedScene {
    let (blue, red) = (Vec3::new(1.0, 0.0, 1.0), Vec3::new(-1.0, 0.0, 1.0));
    let towards = |from: Vec3, target: Vec3, normal: Vec3, pdf: f32, is_delta: bool| {
        let cos = normal.normalize().dot((target - from).normalize());
        Some(uniform(target, pdf / cos, pdf, is_delta))
    };
    let blue_normal = Vec3::new(-1.0, 0.0, -1.0);
    let mut scene = scene(towards(Vec3::ZERO, blue, Vec3::Z, 20.0, false));
    let panel = facing(blue, blue_normal).map(|corner| corner.as_dvec3());
    let glow = Material { emission: Rgb::new(0.0, 0.0, 1.0), ..scenes::grey(0.0, 0.0) };
    scenes::add(&mut scene.scene, &[panel], glow);
    scene.bsdfs.push(towards(blue, red, blue_normal, 0.25, true));
    let vertices = facing(red, Vec3::new(0.6, 0.0, 0.8));
    scene.scene.lights = vec![LightDescription::Triangle { vertices, radiance: Rgb::new(1.0, 0.0, 0.0) }];
    scene.lights = vec![Some(ScriptedLight { point: red, pdf_area: 2.0, pdf_area_on_hit: 2.0 })];
    scene
}

/// A BSDF with the same density for all directions.
fn uniform(target: Vec3, f: f32, pdf: f32, is_delta: bool) -> ScriptedBsdf {
    ScriptedBsdf { target, f, pdf, pdf_at_viewer: pdf, pdf_elsewhere: pdf, is_delta }
}

/// A triangle around a point whose front has this normal.
fn facing(middle: Vec3, normal: Vec3) -> [Vec3; 3] {
    let frame = Frame::around(normal.normalize());
    [(0.2, 0.0), (-0.1, 0.15), (-0.1, -0.15)].map(|(x, y)| middle + frame.to_world(Vec3::new(x, y, 0.0)))
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
        lights: vec![Some(ScriptedLight { point: LIGHT, pdf_area: 2.0, pdf_area_on_hit: 2.0 })],
        origin: Vec3::new(-0.2, 0.0, 1.0),
        direction: Vec3::new(0.2, 0.0, -1.0).normalize(),
    }
}
