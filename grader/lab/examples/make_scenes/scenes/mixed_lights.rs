//! A bit of everything, quick to render.

use glam::dvec3;

use crate::collection::Collection;
use crate::model::{Material, Model};
use crate::scene_file::{Camera, Light, ModelUse, SceneFile};
use crate::shapes::{Bottom, block, ceiling, floor, panel};
use crate::solids::icosphere;

pub(super) fn add_to(collection: &mut Collection) {
    collection.models.push(
        Model::new("mixed_lights", "A box, a faceted mirror ball and a panel under a light")
            .with(Material::diffuse("floor", [0.6, 0.58, 0.54]), floor(0.0, [-3.5, 3.5], [-3.0, 3.5]))
            .with(
                Material::diffuse("box", [0.7, 0.35, 0.15]),
                block(dvec3(-1.1, 0.0, 0.1), dvec3(0.9, 0.9, 0.9), 28.0, Bottom::Open),
            )
            .with(
                Material::mirror("mirror_ball", [0.9, 0.9, 0.92]),
                icosphere(dvec3(0.9, 0.68, 0.6), 0.62, 1),
            )
            .with(
                Material::part_mirror("part_mirror", [0.25, 0.35, 0.3], [0.5, 0.5, 0.5]),
                panel(dvec3(0.3, 1.05, -1.6), dvec3(-0.15, 0.12, 1.0), 1.7, 0.95),
            )
            .with(Material::lamp("light", [30.0, 27.0, 22.0]), ceiling(3.4, [-0.9, 0.1], [-0.3, 0.7])),
    );
    collection.scenes.push(SceneFile {
        name: "mixed_lights",
        about: &[
            "The least that has everything: a light with an area and a point light; diffuse surfaces, a",
            "mirror, and a panel that is half diffuse and half mirror. Quick to render, for first tries",
            "and for tests that need one scene with all the special cases.",
        ],
        models: vec![ModelUse::plain("mixed_lights")],
        camera: Camera { eye: dvec3(0.0, 2.2, 6.0), center: dvec3(0.0, 0.8, 0.0), fov: 38.0 },
        lights: vec![Light::Point { position: dvec3(2.1, 2.2, 1.6), power: [36.0, 40.0, 54.0] }],
        max_bounces: 6,
    });
}
