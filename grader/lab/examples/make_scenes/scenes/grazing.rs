//! Direct light where it is easily lost: at grazing angles, on coarse smooth meshes, behind lights.

use glam::{DVec3, dvec3};

use crate::collection::Collection;
use crate::model::{Material, Model};
use crate::scene_file::{Camera, Light, ModelUse, SceneFile};
use crate::shapes::{ceiling, floor};
use crate::solids::smooth_sphere;

pub(super) fn add_to(collection: &mut Collection) {
    let depth = [-6.0, 4.5];
    collection.models.push(
        Model::new("grazing", "A glossy and a diffuse floor, a coarse smooth ball and a panel that emits")
            .with(
                Material::glossy("gloss", [0.05; 3], [0.8, 0.75, 0.7], 20.0),
                floor(0.0, [-4.0, 0.2], depth),
            )
            .with(Material::diffuse("floor", [0.6, 0.65, 0.7]), floor(0.0, [0.2, 4.0], depth))
            // 80 triangles: a face is as large as three pixels of the grader's picture.
            .with(Material::diffuse("ball", [0.7, 0.6, 0.5]), smooth_sphere(dvec3(-0.75, 1.1, -0.2), 0.75, 1))
            .with(Material::lamp("panel", [1.0, 1.0, 1.2]), ceiling(1.5, [0.7, 1.7], [-0.6, 0.8])),
    );
    collection.scenes.push(SceneFile {
        name: "grazing",
        about: &[
            "Left: a glossy floor seen at a grazing angle, where many BSDF samples are below the horizon, and",
            "a ball of 80 triangles whose normals are interpolated. Right: a light with an area in front of",
            "a point light, which casts a shadow on the floor. One bounce: direct light only.",
        ],
        models: vec![ModelUse::plain("grazing")],
        camera: Camera { eye: dvec3(0.0, 0.7, 5.0), center: DVec3::Y * 0.5, fov: 40.0 },
        lights: vec![
            Light::Point { position: dvec3(-0.6, 1.7, -4.0), power: [120.0, 120.0, 100.0] },
            Light::Point { position: dvec3(1.2, 3.2, 1.2), power: [150.0, 140.0, 120.0] },
        ],
        max_bounces: 1,
    });
}
