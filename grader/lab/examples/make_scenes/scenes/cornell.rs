//! The simple box: figure 1 of the sheet, and its twin with a point light.

use glam::{DVec3, dvec3};

use crate::collection::Collection;
use crate::model::{Material, Model};
use crate::scene_file::{Camera, Light, ModelUse, SceneFile};
use crate::shapes::{Bottom, block, ceiling, floor, panel};
use crate::surface::Surface;

/// The room: 2.4 wide, 2 high, 2.2 deep, open towards +z.
pub(crate) const X: [f64; 2] = [-1.2, 1.2];
pub(crate) const Z: [f64; 2] = [-1.1, 1.1];
pub(super) const HEIGHT: f64 = 2.0;

pub(super) const WHITE: [f64; 3] = [0.74, 0.73, 0.7];
const RED: [f64; 3] = [0.6, 0.08, 0.07];
const GREEN: [f64; 3] = [0.12, 0.46, 0.12];

/// How far lights hang below the ceiling. If they lay in it, rays could not tell the two apart.
pub(super) const LIGHT_GAP: f64 = 0.015;

/// The opening fills the width of the picture but for a small rim, and its height at 512 × 412.
pub(super) fn camera() -> Camera {
    Camera { eye: dvec3(0.0, 1.0, 4.63), center: dvec3(0.0, 1.0, 0.0), fov: 39.0 }
}

/// Adds the room with a floor of its own material, so that one box may have another floor.
pub(super) fn with_room(model: Model, floor_material: Material) -> Model {
    let middle = HEIGHT / 2.0;
    let [half_width, half_depth] = [(X[1] - X[0]) / 2.0, (Z[1] - Z[0]) / 2.0];
    let back = panel(dvec3(0.0, middle, Z[0]), DVec3::Z, half_width, middle);
    model
        .with(floor_material, floor(0.0, X, Z))
        .with(Material::diffuse("white", WHITE), ceiling(HEIGHT, X, Z).joined(back))
        .with(Material::diffuse("red", RED), panel(dvec3(X[0], middle, 0.0), DVec3::X, half_depth, middle))
        .with(
            Material::diffuse("green", GREEN),
            panel(dvec3(X[1], middle, 0.0), DVec3::NEG_X, half_depth, middle),
        )
}

/// The tall block stands at the back left.
pub(super) fn tall_block() -> Surface {
    block(dvec3(-0.43, 0.0, -0.36), dvec3(0.62, 1.22, 0.62), 18.0, Bottom::Open)
}

/// The short block stands at the front right.
pub(super) fn short_block() -> Surface {
    block(dvec3(0.42, 0.0, 0.32), dvec3(0.62, 0.58, 0.62), -17.0, Bottom::Open)
}

/// A light below the ceiling that looks down.
pub(super) fn ceiling_light(x: [f64; 2], z: [f64; 2]) -> Surface {
    ceiling(HEIGHT - LIGHT_GAP, x, z)
}

pub(super) fn add_to(collection: &mut Collection) {
    let room = Model::new("cornell_room", "A room with a red and a green wall, open at the front");
    collection.models.push(with_room(room, Material::diffuse("floor", WHITE)));
    collection.models.push(
        Model::new("cornell_blocks", "Two blocks that stand on the floor of cornell_room")
            .with(Material::diffuse("blocks", WHITE), tall_block().joined(short_block())),
    );
    collection.models.push(
        Model::new("cornell_light", "A small light under the ceiling of cornell_room").with(
            Material::lamp("ceiling_light", [30.0, 25.0, 18.0]),
            ceiling_light([-0.28, 0.28], [-0.22, 0.22]),
        ),
    );
    collection.scenes.push(SceneFile {
        name: "cornell_box",
        about: &[
            "The simple box: diffuse surfaces and one small light. Figure 1 of the sheet.",
            "BSDF sampling seldom hits the light; next event estimation finds it at every hit point.",
        ],
        models: ["cornell_room", "cornell_blocks", "cornell_light"].map(ModelUse::plain).into(),
        camera: camera(),
        lights: Vec::new(),
        max_bounces: 8,
    });
    collection.scenes.push(SceneFile {
        name: "cornell_box_point",
        about: &[
            "The simple box with a point light in place of the ceiling light. Figure 2 of the sheet.",
            "No ray can hit a point: BSDF sampling leaves the picture black, all light comes from",
            "next event estimation.",
        ],
        models: ["cornell_room", "cornell_blocks"].map(ModelUse::plain).into(),
        camera: camera(),
        lights: vec![Light::Point { position: dvec3(0.1, 1.45, 0.4), power: [36.0, 33.0, 28.0] }],
        max_bounces: 8,
    });
    collection.scenes.push(SceneFile {
        name: "three_points",
        about: &[
            "The simple box with three point lights of unequal colour and power: the one that is",
            "picked has to be divided by the probability of picking it.",
        ],
        models: ["cornell_room", "cornell_blocks"].map(ModelUse::plain).into(),
        camera: camera(),
        lights: vec![
            Light::Point { position: dvec3(-0.5, 1.5, 0.5), power: [30.0, 12.0, 8.0] },
            Light::Point { position: dvec3(0.6, 1.4, 0.2), power: [6.0, 16.0, 7.0] },
            Light::Point { position: dvec3(0.2, 1.0, 0.9), power: [2.0, 4.0, 10.0] },
        ],
        max_bounces: 8,
    });
}
