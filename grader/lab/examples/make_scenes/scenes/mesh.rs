//! Many triangles and a texture.

use glam::{DVec3, dvec3};

use crate::collection::Collection;
use crate::model::{Material, Model};
use crate::picture;
use crate::scene_file::{Camera, ModelUse, SceneFile, Step};
use crate::shapes::{ceiling, floor, textured};
use crate::solids::{KnotResolution, knot};

/// 50,400 triangles.
pub(crate) const RESOLUTION: KnotResolution = KnotResolution { along: 420, around: 60 };

const TEXTURE: &str = "mesh_tiles.png";

pub(super) fn add_to(collection: &mut Collection) {
    collection.textures.push((TEXTURE, picture::tiles()));
    collection.models.push(
        Model::new("mesh_knot", "A knotted rope")
            .with(Material::glossy("rope", [0.62, 0.3, 0.12], [0.2, 0.2, 0.2], 40.0), knot(&RESOLUTION)),
    );
    collection.models.push(
        Model::new("mesh_floor", "A tiled floor and a light above it")
            .with(
                Material::diffuse("tiles", [1.0, 1.0, 1.0]).textured(TEXTURE),
                textured(floor(0.0, [-10.0, 10.0], [-15.0, 5.0]), 10.0, 10.0),
            )
            .with(Material::lamp("light", [40.0, 38.0, 34.0]), ceiling(5.5, [-2.3, -0.7], [-0.2, 1.4])),
    );
    collection.scenes.push(SceneFile {
        name: "mesh",
        about: &[
            "A smooth mesh of 50,400 triangles on a textured floor.",
            "Shows the cost of a large mesh, shading normals, texture coordinates and textures.",
        ],
        models: vec![
            ModelUse {
                model: "mesh_knot",
                steps: vec![
                    Step::Rotate { axis: DVec3::X, degrees: 58.0 },
                    Step::Translate(dvec3(0.0, 1.82, 0.0)),
                ],
            },
            ModelUse::plain("mesh_floor"),
        ],
        camera: Camera { eye: dvec3(0.0, 3.3, 6.6), center: dvec3(0.0, 1.6, 0.0), fov: 41.0 },
        lights: Vec::new(),
        max_bounces: 6,
    });
}
