//! Closed spheres that emit and reflect: the answer is known without rendering.

use glam::{DVec3, dvec3};

use crate::collection::Collection;
use crate::model::{Material, Model};
use crate::scene_file::{Camera, ModelUse, SceneFile};
use crate::solids::icosphere;

const RADIUS: f64 = 2.0;

/// 5120 triangles. With few and large ones, points near an edge would be lit at grazing angles from close
/// by, and next event estimation would have a variance without bounds.
const SUBDIVISIONS: u32 = 4;

const RADIANCE: [f64; 3] = [0.5, 0.5, 0.5];

pub(super) fn add_to(collection: &mut Collection) {
    let mut add = |name, model_about, material: Material, about| {
        let sphere = icosphere(DVec3::ZERO, RADIUS, SUBDIVISIONS).flipped();
        collection.models.push(Model::new(name, model_about).with(material.emitting(RADIANCE), sphere));
        collection.scenes.push(SceneFile {
            name,
            about,
            models: vec![ModelUse::plain(name)],
            // Away from the centre, so that distances and angles differ from pixel to pixel.
            camera: Camera { eye: dvec3(0.7, 0.4, 0.9), center: dvec3(-0.6, -0.3, -1.0), fov: 70.0 },
            lights: Vec::new(),
            max_bounces: 8,
        });
    };
    add(
        "furnace_diffuse",
        "A sphere that emits and reflects inwards, diffuse",
        Material::diffuse("furnace", [0.5, 0.5, 0.5]),
        &[
            "Inside a closed diffuse sphere with emitted radiance L = 0.5 and reflectance r = 0.5.",
            "Each pixel is L (1 - r^(k+1)) / (1 - r) after k bounces, thus 1 in the end. The difference",
            "between one number of bounces and the next tells which bounce is wrong.",
        ],
    );
    add(
        "furnace_glossy",
        "A sphere that emits and reflects inwards, glossy",
        Material::glossy("furnace", [0.0, 0.0, 0.0], [0.6, 0.6, 0.6], 20.0),
        &[
            "Inside a closed sphere that emits a radiance of 0.5 and has a Phong lobe of exponent 20.",
            "What the lobe reflects depends on the angle, so only one bounce has a closed form (by",
            "quadrature): the emitted radiance times one plus the lobe's albedo at that angle.",
        ],
    );
}
