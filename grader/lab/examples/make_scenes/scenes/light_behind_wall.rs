//! What hides light: things before it, its own back, and not the wall behind it.

use glam::{DVec3, dvec3};

use crate::collection::Collection;
use crate::model::{Material, Model};
use crate::scene_file::{Camera, Light, ModelUse, SceneFile};
use crate::shapes::{ceiling, floor, panel, rectangle};

/// Two rooms side by side, each 2.2 wide at the front, which is open towards +z. Between them stands a wedge
/// with its edge at the front, so that the camera sees both of its sides.
pub(crate) const X: [f64; 2] = [-2.2, 2.2];
const Z: [f64; 2] = [-1.4, 1.4];
const HEIGHT: f64 = 3.6;

/// Half of the wedge's width at the back wall.
const WEDGE: f64 = 0.6;

pub(super) fn add_to(collection: &mut Collection) {
    let middle = HEIGHT / 2.0;
    let side = |x, normal| panel(dvec3(x, middle, 0.0), normal, Z[1], middle);
    let depth = Z[1] - Z[0];
    let wedge_side = |towards: f64| {
        let normal = dvec3(towards * depth, 0.0, WEDGE);
        panel(dvec3(towards * WEDGE / 2.0, middle, 0.0), normal, depth.hypot(WEDGE) / 2.0, middle)
    };
    let back = panel(dvec3(0.0, middle, Z[0]), DVec3::Z, X[1], middle);
    collection.models.push(
        Model::new("light_behind_wall", "Two rooms with things that hide a light")
            .with(Material::diffuse("room", [0.7, 0.7, 0.68]), ceiling(HEIGHT, X, Z).joined(back))
            .with(Material::diffuse("floor", [0.7, 0.7, 0.68]), floor(0.0, X, Z))
            .with(Material::diffuse("left_wall", [0.65, 0.4, 0.2]), side(X[0], DVec3::X))
            .with(Material::diffuse("wedge", [0.7, 0.7, 0.7]), wedge_side(-1.0).joined(wedge_side(1.0)))
            .with(Material::diffuse("right_wall", [0.2, 0.4, 0.65]), side(X[1], DVec3::NEG_X))
            .with(
                // Between the left light and the wedge, upright.
                Material::diffuse("screen", [0.5, 0.5, 0.5]),
                panel(dvec3(-0.85, 1.6, 0.1), DVec3::NEG_X, 0.5, 0.4),
            )
            .with(
                // Between the right light and the floor, level.
                Material::diffuse("shelf", [0.5, 0.5, 0.5]),
                rectangle(dvec3(1.15, 1.3, 0.1), DVec3::X * 0.45, DVec3::NEG_Z * 0.6),
            )
            .with(
                Material::lamp("left_light", [12.0, 11.0, 9.0]),
                panel(dvec3(-1.55, 2.2, 0.0), DVec3::X, 0.42, 0.35),
            ),
    );
    collection.scenes.push(SceneFile {
        name: "light_behind_wall",
        about: &[
            "Left: a light with an area that shines to the right, past a screen, at a wedge between the rooms.",
            "Right: a point light above a shelf. Screen and shelf cast shadows. Behind both lights are",
            "walls: a shadow ray that does not end at the light hits them, and nearly all would be dark.",
            "The left wall is behind the light's back: it gets no direct light at all.",
        ],
        models: vec![ModelUse::plain("light_behind_wall")],
        camera: Camera { eye: dvec3(0.0, middle, 7.6), center: dvec3(0.0, middle, 0.0), fov: 41.0 },
        lights: vec![Light::Point { position: dvec3(1.2, 2.5, 0.2), power: [30.0, 30.0, 30.0] }],
        max_bounces: 6,
    });
}
