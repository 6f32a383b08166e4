//! Light that only one technique can find counts whole.

use std::collections::BTreeMap;

use arty::integrator::Settings;
use arty::math::{Rgb, Vec3};
use arty::scene::{
    CameraDescription, Defaults, LightDescription, Material, Mesh, MeshTriangle, SceneDescription, Specular,
};
use host::protocol::{ProbeJob, ScriptedBsdf, ScriptedLight, ScriptedScene};

use super::{NOISE, TOLERATED, mean_and_error};
use crate::checks::Stop;
use harness::host_process::HostProcess;

/// What became of these lights.
#[derive(Default)]
pub(super) struct Special {
    /// The first that does not count whole, in words.
    pub(super) complaint: Option<String>,
    /// How much of each counts.
    pub(super) weights: BTreeMap<String, f64>,
}

/// Looks at each.
pub(super) fn look(
    process: &mut HostProcess,
    settings: Settings,
    samples: u64,
    seed: u64,
) -> Result<Special, Stop> {
    let cases = [
        ("a light that the camera sees", seen_by_camera(), 1.0),
        ("a light that is hit after a delta bounce", after_delta(), 1.0),
        ("a light without an area", point_light(), 1.0),
    ];
    let mut special = Special::default();
    for (name, scene, expected) in cases {
        let paths = process.probe(&ProbeJob {
            settings,
            scenes: vec![scene],
            samples,
            seed,
            stratified: false,
        })??;
        let Some((mean, error)) = mean_and_error(&paths[0]) else {
            special.complaint.get_or_insert_with(|| format!("{name} gives NaN or infinity"));
            continue;
        };
        special.weights.insert(name.to_owned(), mean);
        if (mean - expected).abs() > TOLERATED + NOISE * error {
            special.complaint.get_or_insert_with(|| {
                format!("{name} has the weight {mean:.3}; it can be found in one way only, so it should be 1")
            });
        }
    }
    Ok(special)
}

/// The camera looks straight at the light.
fn seen_by_camera() -> ScriptedScene {
    let mut scene = scene(None);
    scene.origin = Vec3::new(0.3, 0.0, 0.5);
    scene.direction = (LIGHT - scene.origin).normalize();
    scene
}

/// The surface reflects everything straight to the light, with a probability of a quarter; densities are such that
/// any weight but 1 shows.
fn after_delta() -> ScriptedScene {
    let direction = LIGHT.normalize();
    let f = 0.25 / direction.z;
    scene(Some(ScriptedBsdf { target: LIGHT, f, pdf: 0.25, is_delta: true }))
}

/// A point light of intensity such that f · I · cos / d² = 1, and a BSDF sample that goes nowhere.
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

/// The middle of the light.
const LIGHT: Vec3 = Vec3::new(1.0, 0.25, 1.0);

/// A surface in the plane z = 0 around the origin, and a light of radiance 1 that faces it.
fn scene(bsdf: Option<ScriptedBsdf>) -> ScriptedScene {
    let around = |middle: Vec3, up: f32| {
        [(0.2, 0.0), (-0.1, 0.15 * up), (-0.1, -0.15 * up)].map(|(x, y)| middle + Vec3::new(x, y, 0.0))
    };
    ScriptedScene {
        scene: SceneDescription {
            camera: CameraDescription { eye: Vec3::Z, center: Vec3::ZERO, up: Vec3::Y, fov: 40.0 },
            meshes: vec![Mesh {
                positions: around(Vec3::ZERO, 1.0).to_vec(),
                triangles: vec![MeshTriangle { positions: [0, 1, 2], normals: None, uvs: None, material: 0 }],
                ..Mesh::default()
            }],
            materials: vec![Material {
                name: "scripted".to_owned(),
                diffuse: Rgb::BLACK,
                diffuse_map: None,
                specular: Specular::None,
                emission: Rgb::BLACK,
            }],
            textures: Vec::new(),
            lights: vec![LightDescription::Triangle { vertices: around(LIGHT, -1.0), radiance: Rgb::WHITE }],
            defaults: Defaults::default(),
        },
        bsdfs: vec![bsdf],
        lights: vec![Some(ScriptedLight { point: LIGHT, pdf_area: 2.0 })],
        origin: Vec3::new(-0.2, 0.0, 1.0),
        direction: Vec3::new(0.2, 0.0, -1.0).normalize(),
    }
}
