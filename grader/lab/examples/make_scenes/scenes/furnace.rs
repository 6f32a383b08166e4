//! Closed spheres that emit and reflect: the answer is known without rendering.

use glam::{DVec3, dvec3};

use crate::collection::Collection;
use crate::model::{Material, Model};
use crate::scene_file::{Camera, ModelUse, SceneFile};
use crate::shapes::{Bottom, block};
use crate::solids::icosphere;
use crate::surface::Surface;

const RADIUS: f64 = 2.0;

/// 5120 triangles. With few and large ones, points near an edge would be lit at grazing angles from close
/// by, and next event estimation would have a variance without bounds.
const SUBDIVISIONS: u32 = 4;

const RADIANCE: [f64; 3] = [0.5, 0.5, 0.5];

/// Away from the centre, so that distances and angles differ from pixel to pixel.
const CAMERA: Camera = Camera { eye: dvec3(0.7, 0.4, 0.9), center: dvec3(-0.6, -0.3, -1.0), fov: 70.0 };

pub(super) fn add_to(collection: &mut Collection) {
    uniform(collection);
    glass(collection);
    cap(collection);
}

/// Spheres of one material that emits.
fn uniform(collection: &mut Collection) {
    let mut add = |name, model_about, material: Material, subdivisions, about| {
        let sphere = icosphere(DVec3::ZERO, RADIUS, subdivisions).flipped();
        collection.models.push(Model::new(name, model_about).with(material.emitting(RADIANCE), sphere));
        collection.scenes.push(SceneFile {
            name,
            about,
            models: vec![ModelUse::plain(name)],
            camera: CAMERA,
            lights: Vec::new(),
            max_bounces: 8,
        });
    };
    add(
        "furnace_diffuse",
        "A sphere that emits and reflects inwards, diffuse",
        Material::diffuse("furnace", [0.5, 0.5, 0.5]),
        SUBDIVISIONS,
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
        SUBDIVISIONS,
        &[
            "Inside a closed sphere that emits a radiance of 0.5 and has a Phong lobe of exponent 20.",
            "What the lobe reflects depends on the angle, so only one bounce has a closed form (by",
            "quadrature): the emitted radiance times one plus the lobe's albedo at that angle.",
        ],
    );
    add(
        "furnace_mirror",
        "A sphere that emits and reflects inwards, a perfect mirror",
        Material::mirror("furnace", [0.8, 0.5, 0.2]),
        1,
        &[
            "Inside a closed mirror of reflectance r that emits a radiance L = 0.5.",
            "Each pixel is L (1 - r^(k+1)) / (1 - r) after k bounces, without any noise: no light sample can",
            "find what a mirror shows, so that each hit counts whole.",
        ],
    );
}

/// Glass before a background that shines the same everywhere.
fn glass(collection: &mut Collection) {
    let name = "furnace_glass";
    let background = icosphere(DVec3::ZERO, RADIUS, 1).flipped();
    // Opposite sides are parallel: what came in through one gets out through the other. In a ball of flat triangles some
    // light would be caught for good.
    let block = block(dvec3(-0.2, -0.6, -0.4), dvec3(1.0, 0.9, 0.8), 25.0, Bottom::Closed);
    collection.models.push(
        Model::new(name, "A shining sphere around a block of glass")
            .with(Material::lamp("background", RADIANCE), background)
            .with(Material::glass("glass", 1.5, [1.0; 3]), block),
    );
    collection.scenes.push(SceneFile {
        name,
        about: &[
            "A block of clear glass before a background of radiance 0.5 all around.",
            "Whatever way a path takes through the glass, it ends at the background: each pixel is 0.5, but for",
            "the little that is still on its way after the last bounce.",
        ],
        models: vec![ModelUse::plain(name)],
        camera: CAMERA,
        lights: Vec::new(),
        max_bounces: 64,
    });
}

/// A sphere of which a part emits.
fn cap(collection: &mut Collection) {
    let name = "furnace_cap";
    let sphere = icosphere(DVec3::ZERO, RADIUS, SUBDIVISIONS).flipped();
    // The cap's share of the sphere is (1 - 0.6) / 2 = 0.2, but for its jagged edge.
    let (cap, rest): (Vec<_>, Vec<_>) = sphere.triangles.iter().partition(|triangle| {
        let [a, b, c] = sphere.corners(triangle);
        (a + b + c).y > 3.0 * 0.6 * RADIUS
    });
    let part = |triangles: Vec<[usize; 3]>| {
        let corners: Vec<DVec3> = triangles.iter().flat_map(|triangle| sphere.corners(triangle)).collect();
        let triangles = (0..triangles.len()).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        Surface::new(corners, triangles)
    };
    let material = |name| Material::diffuse(name, [0.7, 0.5, 0.3]);
    collection.models.push(
        Model::new(name, "A diffuse sphere with a cap that emits")
            .with(material("cap").emitting([2.0; 3]), part(cap))
            .with(material("wall"), part(rest)),
    );
    collection.scenes.push(SceneFile {
        name,
        about: &[
            "Inside a closed diffuse sphere of reflectance r, of which the share f at the top emits a radiance of 2.",
            "In a sphere each point gets light from all others alike: all that is not the cap itself shows",
            "f L (r + r^2 + ... + r^k) after k bounces, but for the corners of the triangles.",
        ],
        models: vec![ModelUse::plain(name)],
        camera: CAMERA,
        lights: Vec::new(),
        max_bounces: 8,
    });
}
