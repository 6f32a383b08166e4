//! Indirect light where it is easily lost: walls without red, a lamp that many bounces hit, a broad lobe.

use glam::{DVec3, dvec3};

use crate::collection::Collection;
use crate::model::{Material, Model};
use crate::scene_file::{Camera, ModelUse, SceneFile};
use crate::shapes::{ceiling, floor, panel};

/// A closed room.
const X: [f64; 2] = [-1.5, 1.5];
const Z: [f64; 2] = [-1.5, 1.5];
const HEIGHT: f64 = 2.2;

pub(super) fn add_to(collection: &mut Collection) {
    let middle = HEIGHT / 2.0;
    let wall = |x: f64, z: f64| panel(dvec3(x, middle, z), dvec3(-x, 0.0, -z), 1.5, middle);
    let walls = [(X[1], 0.0), (0.0, Z[0]), (0.0, Z[1])]
        .into_iter()
        .fold(wall(X[0], 0.0), |walls, (x, z)| walls.joined(wall(x, z)));
    collection.models.push(
        Model::new("lamp_room", "A closed room without red walls, and a large lamp")
            .with(Material::diffuse("walls", [0.0, 0.85, 0.6]), walls.joined(ceiling(HEIGHT, X, Z)))
            .with(Material::glossy("floor", [0.1; 3], [0.6, 0.75, 0.85], 4.0), floor(0.0, X, Z))
            // Half a unit from everything else: close to a wall, next event estimation is noisy.
            .with(Material::lamp("lamp", [1.0; 3]), ceiling(1.7, [-1.1, 1.1], [-1.1, 1.1])),
    );
    collection.scenes.push(SceneFile {
        name: "lamp_room",
        about: &[
            "A closed room whose walls reflect no red: the throughput of most paths has none, and a probability",
            "of survival that depends on red alone is zero. A third of the bounces hits the lamp, which reflects",
            "nothing. The floor has a lobe so broad that many of its samples are below the horizon.",
        ],
        models: vec![ModelUse::plain("lamp_room")],
        camera: Camera { eye: dvec3(0.0, 1.0, 1.4), center: DVec3::Y * 0.75, fov: 80.0 },
        lights: Vec::new(),
        max_bounces: 8,
    });
}
