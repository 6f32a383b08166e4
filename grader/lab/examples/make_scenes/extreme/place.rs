//! The same room at other scales and positions.

use std::f64::consts::PI;

use glam::{DVec3, dvec3};

use super::answer::Truth;
use super::{Answer, Extremes};
use crate::model::{Material, Model};
use crate::scene_file::{Camera, Light, ModelUse, SceneFile, Step};
use crate::shapes::{Bottom, block, ceiling, floor, panel};

/// Name, comment, scale, distance from the origin in sizes of the scene.
const PLACES: [(&str, &[&str], f64, f64); 6] = [
    ("place_here", &["A room with a block and two kinds of light, for comparison."], 1.0, 0.0),
    ("place_small", &["The room of place_here, ten thousand times smaller."], 1e-4, 0.0),
    ("place_large", &["The room of place_here, ten thousand times larger."], 1e4, 0.0),
    ("place_far", &["The room of place_here, a thousand times its size from the origin."], 1.0, 1e3),
    ("place_small_far", &["The room of place_here, smaller and far from the origin."], 1e-4, 1e3),
    ("place_large_far", &["The room of place_here, larger and far from the origin."], 1e4, 1e3),
];

/// About how large the room is.
const SIZE: f64 = 4.0;

pub(super) fn add_to(extremes: &mut Extremes) {
    let walls = floor(0.0, [-1.5, 1.5], [-1.5, 1.5]).joined(panel(dvec3(0.0, 1.0, -1.5), DVec3::Z, 1.5, 1.0));
    extremes.collection.models.push(
        Model::new("room", "A floor, a wall, a block, and a light with an area")
            .with(Material::diffuse("walls", [0.6; 3]), walls)
            .with(
                Material::glossy("block", [0.3; 3], [0.3; 3], 20.0),
                block(dvec3(-0.2, 0.0, 0.1), dvec3(0.6, 0.7, 0.5), 25.0, Bottom::Open),
            )
            .with(Material::lamp("lamp", [8.0; 3]), ceiling(1.9, [-0.4, 0.2], [-0.3, 0.3])),
    );
    for (name, about, scale, distance) in PLACES {
        let offset = scale * distance * SIZE * dvec3(0.6, 0.48, 0.64);
        let at = |point: DVec3| scale * point + offset;
        let mut steps = Vec::new();
        if scale != 1.0 {
            steps.push(Step::Scale(scale));
        }
        if distance != 0.0 {
            steps.push(Step::Translate(offset));
        }
        // The power of a point light has to grow with the area that it lights.
        let power = [4.0 * PI * 1.5 * scale * scale; 3];
        let scene = SceneFile {
            name,
            about,
            models: vec![ModelUse { model: "room", steps }],
            camera: Camera { eye: at(dvec3(0.3, 1.2, 3.2)), center: at(dvec3(0.0, 0.6, 0.0)), fov: 45.0 },
            lights: vec![Light::Point { position: at(dvec3(0.9, 1.4, 0.6)), power }],
            max_bounces: 3,
        };
        let answer = Answer::new(Truth::SameAs("place_here"), "radiance does not depend on size or place")
            .without("bsdf", "no path hits its point light");
        // A coordinate is rounded by up to 2⁻²⁴ of the distance, which is 2.4e-4 of the room.
        let answer = answer.within(if distance == 0.0 { 2e-3 } else { 5e-3 });
        extremes.add(scene, answer);
    }
}
