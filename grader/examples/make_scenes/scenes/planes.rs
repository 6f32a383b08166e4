//! One light above one diffuse plane: closed forms, and nothing that could blur them.

use glam::{DVec3, dvec3};

use crate::collection::Collection;
use crate::model::{Material, Model};
use crate::scene_file::{Camera, Light, ModelUse, SceneFile};
use crate::shapes::{ceiling, floor};

/// How far above the plane the lights are.
const LIGHT_HEIGHT: f64 = 2.0;

/// Looks under the light at the plane. The plane fills the picture, wide or square; the light is not in it.
fn camera() -> Camera {
    Camera { eye: dvec3(0.0, 2.4, 3.0), center: DVec3::ZERO, fov: 40.0 }
}

pub(super) fn add_to(collection: &mut Collection) {
    let plane = floor(0.0, [-4.0, 4.0], [-5.0, 3.0]);
    collection.models.push(
        Model::new("plane", "A diffuse plane").with(Material::diffuse("plane", [0.5, 0.5, 0.5]), plane),
    );
    collection.models.push(Model::new("area_plane_light", "A square light that looks down").with(
        Material::lamp("square_light", [10.0, 10.0, 10.0]),
        ceiling(LIGHT_HEIGHT, [-0.5, 0.5], [-0.5, 0.5]),
    ));
    collection.scenes.push(SceneFile {
        name: "point_plane",
        about: &[
            "A point light of intensity I = color / (4 pi) two units above a diffuse plane.",
            "The irradiance is I cos(angle) / distance^2; the plane shows irradiance * 0.5 / pi.",
        ],
        models: vec![ModelUse::plain("plane")],
        camera: camera(),
        lights: vec![Light::Point { position: DVec3::Y * LIGHT_HEIGHT, power: [100.0, 100.0, 100.0] }],
        max_bounces: 1,
    });
    collection.scenes.push(SceneFile {
        name: "area_plane",
        about: &[
            "A square light of side 1 and radiance 10, two units above a diffuse plane and parallel to it.",
            "The irradiance has a closed form (configuration factors of four rectangles); the light",
            "reflects nothing, so there is no indirect light. The plane shows irradiance * 0.5 / pi.",
        ],
        models: ["plane", "area_plane_light"].map(ModelUse::plain).into(),
        camera: camera(),
        lights: Vec::new(),
        max_bounces: 1,
    });
}
