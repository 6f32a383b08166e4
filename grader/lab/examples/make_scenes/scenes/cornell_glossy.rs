//! The box of figure 3: a large light and glossy things.

use glam::dvec3;

use crate::collection::Collection;
use crate::model::{Material, Model};
use crate::scene_file::{ModelUse, SceneFile};
use crate::scenes::cornell;
use crate::shapes::{Bottom, tapered_block};

pub(super) fn add_to(collection: &mut Collection) {
    // The floor mirrors the room softly; the blocks show the light nearly sharp, at two degrees of gloss.
    let floor = Material::glossy("glossy_floor", [0.36, 0.33, 0.28], [0.4, 0.4, 0.4], 60.0);
    let left = Material::glossy("left_block", [0.06, 0.06, 0.07], [0.85, 0.85, 0.85], 1000.0);
    let right = Material::glossy("right_block", [0.12, 0.09, 0.04], [0.8, 0.7, 0.5], 200.0);
    // Their sides lean back, so that the camera sees the light in them.
    let [left_foot, right_foot] = [dvec3(-0.5, 0.0, -0.3), dvec3(0.52, 0.0, 0.1)];
    let left_block = tapered_block(left_foot, dvec3(1.0, 0.6, 1.0), 0.12, 9.0, Bottom::Open);
    let right_block = tapered_block(right_foot, dvec3(0.85, 0.4, 0.85), 0.2, -12.0, Bottom::Open);
    // It keeps 0.35 away from the walls: where a light touches a wall, next event estimation has a variance
    // without bounds.
    let light = cornell::ceiling_light([-0.85, 0.85], [-0.75, 0.75]);
    let model = Model::new("cornell_box_glossy", "The box with a large light and glossy blocks and floor");
    collection.models.push(
        cornell::with_room(model, floor)
            .with(left, left_block)
            .with(right, right_block)
            .with(Material::lamp("large_light", [1.9, 1.75, 1.5]), light),
    );
    collection.scenes.push(SceneFile {
        name: "cornell_box_glossy",
        about: &[
            "The box with a large light and glossy surfaces. Figure 3 of the sheet.",
            "On the blocks next event estimation is noisy: few points of the light lie in the direction",
            "that the block reflects. On the walls BSDF sampling is noisy. Weighted by multiple importance",
            "sampling, each helps where it is good.",
        ],
        models: vec![ModelUse::plain("cornell_box_glossy")],
        camera: cornell::camera(),
        lights: Vec::new(),
        max_bounces: 8,
    });
}
