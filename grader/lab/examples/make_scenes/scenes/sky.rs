//! Light from the environment.

use arty::image::Image;
use arty::math::Rgb;
use glam::{DVec3, dvec3};

use crate::collection::Collection;
use crate::model::{Material, Model};
use crate::scene_file::{Camera, Light, ModelUse, SceneFile};
use crate::shapes::{ceiling, floor, rectangle};
use crate::solids::{icosphere, smooth_sphere};

/// Size of most maps.
const WIDTH: usize = 64;
const HEIGHT: usize = 32;

/// Columns, rows and radiance of the sun in the sky: two by two texels, in front of the camera, to the right and above.
const SUN: ([usize; 2], [usize; 2], [f64; 3]) = ([40, 41], [8, 9], [90.0, 80.0, 65.0]);

pub(super) fn add_to(collection: &mut Collection) {
    closed_forms(collection);
    collection.maps.push(("sky.exr", map(WIDTH, HEIGHT, sky)));
    balls(collection);
    gloss(collection);
    room(collection);
}

/// A map from a function of column and row.
fn map(width: usize, height: usize, radiance: impl Fn(usize, usize) -> [f64; 3]) -> Image {
    let texel = |index| Rgb::from(radiance(index % width, index / width).map(|channel| channel as f32));
    Image::from_pixels(width, height, (0..width * height).map(texel).collect())
}

/// The direction at the centre of a texel: −z is in the centre of a map, +x to the right of it, +y at its upper edge.
fn direction(column: usize, row: usize) -> DVec3 {
    let azimuth = std::f64::consts::TAU * ((column as f64 + 0.5) / WIDTH as f64 - 0.5);
    let polar = std::f64::consts::PI * (row as f64 + 0.5) / HEIGHT as f64;
    dvec3(polar.sin() * azimuth.sin(), polar.cos(), -polar.sin() * azimuth.cos())
}

/// A convex body in four environments: the light that each face reflects has a closed form.
fn closed_forms(collection: &mut Collection) {
    collection.models.push(
        Model::new("sky_stone", "A diffuse body of 320 flat faces")
            .with(Material::diffuse("stone", [0.6, 0.6, 0.6]), icosphere(DVec3::ZERO, 1.0, 2)),
    );
    let mut add = |name: &'static str, environment: &'static str, about: &'static [&'static str]| {
        collection.scenes.push(SceneFile {
            name,
            about,
            models: vec![ModelUse::plain("sky_stone")],
            camera: Camera { eye: dvec3(0.0, 0.0, 6.0), center: DVec3::ZERO, fov: 18.0 },
            lights: Vec::new(),
            max_bounces: 4,
        });
        collection.environments.insert(name, environment);
    };
    add(
        "sky_furnace",
        "{ color: [0.5, 0.5, 0.5] }",
        &[
            "A convex body of albedo 0.6 in a constant environment of radiance 0.5. Nothing that it reflects comes back, so it",
            "shows 0.6 * 0.5 everywhere, whatever the number of bounces.",
        ],
    );
    add(
        "sky_harmonics",
        "{ file: \"sky_harmonics.exr\" }",
        &[
            "A convex body under spherical harmonics, one in each channel: red is constant (degree 0), green is linear in the",
            "direction (degree 1), blue quadratic (degree 2). The irradiance is pi, 2 pi / 3 and pi / 4 times the harmonic",
            "at the normal, plus pi times the constant that keeps radiance positive (Ramamoorthi and Hanrahan 2001).",
        ],
    );
    add(
        "sky_sun",
        "{ file: \"sky_sun.exr\", rotate: { axis: [0.62, 0, -0.5], degrees: 53 } }",
        &[
            "A convex body under a sun in a black map: a disk of angular radius a = 4 degrees and radiance L. The irradiance is",
            "pi L sin(a)^2 times the cosine of the angle between the normal and the centre of the sun.",
        ],
    );
    add(
        "sky_texel",
        "{ file: \"sky_texel.exr\" }",
        &[
            "A convex body under a dim map of 64 by 32 texels, one of which is 5000 times as bright as the others.",
        ],
    );
    collection.maps.push(("sky_harmonics.exr", map(WIDTH, HEIGHT, harmonics)));
    collection
        .maps
        .push(("sky_sun.exr", map(4, 45, |_, row| if row == 0 { [200.0, 180.0, 150.0] } else { [0.0; 3] })));
    let is_bright = |column, row| (column, row) == (5, 9);
    let texel = |column, row| if is_bright(column, row) { [500.0, 450.0, 350.0] } else { [0.1, 0.09, 0.07] };
    collection.maps.push(("sky_texel.exr", map(WIDTH, HEIGHT, texel)));
}

/// Degree 0, 1 and 2, positive everywhere.
fn harmonics(column: usize, row: usize) -> [f64; 3] {
    let w = direction(column, row);
    [1.0, 1.0 + w.dot(dvec3(0.6, 0.64, 0.48)), 1.0 + w.x * w.y + 0.5 * w.y * w.z]
}

/// A blue sky that is brighter at the horizon, with a sun, over a brown ground.
fn sky(column: usize, row: usize) -> [f64; 3] {
    let (columns, rows, sun) = SUN;
    if rows.contains(&row) && columns.contains(&column) {
        return sun;
    }
    let down = (row as f64 + 0.5) / HEIGHT as f64;
    // A side that is darker: a map that is mirrored or turned looks different.
    let side = 0.75 + 0.25 * (std::f64::consts::TAU * (column as f64 + 0.5) / WIDTH as f64).sin();
    let color = if down < 0.5 { [0.2 + 0.8 * down, 0.35 + 0.7 * down, 0.8] } else { [0.16, 0.12, 0.08] };
    color.map(|channel| channel * side)
}

/// Three balls on a floor.
fn balls(collection: &mut Collection) {
    let ball = |x: f64, z: f64| smooth_sphere(dvec3(x, 0.62, z), 0.6, 3);
    collection.models.push(
        Model::new("sky_balls", "A diffuse, a glossy and a mirror ball on a floor")
            .with(Material::diffuse("floor", [0.5, 0.5, 0.5]), floor(0.0, [-6.0, 6.0], [-6.0, 6.0]))
            .with(Material::diffuse("diffuse_ball", [0.7, 0.45, 0.3]), ball(-1.4, 0.0))
            .with(Material::glossy("glossy_ball", [0.2, 0.25, 0.3], [0.5, 0.5, 0.5], 60.0), ball(0.0, -0.6))
            .with(Material::mirror("mirror_ball", [0.9, 0.9, 0.9]), ball(1.4, 0.0)),
    );
    let mut add = |name: &'static str, environment: &'static str, lights, about: &'static [&'static str]| {
        collection.scenes.push(SceneFile {
            name,
            about,
            models: vec![ModelUse::plain("sky_balls")],
            camera: Camera { eye: dvec3(0.0, 1.7, 5.0), center: dvec3(0.0, 0.4, 0.0), fov: 40.0 },
            lights,
            max_bounces: 8,
        });
        collection.environments.insert(name, environment);
    };
    add(
        "sky_balls",
        "{ file: \"sky.exr\" }",
        Vec::new(),
        &[
            "Three balls under a sky with a small bright sun: BSDF sampling hardly finds the sun, and samples of the sky",
            "alone are noisy where the glossy ball reflects it.",
        ],
    );
    add(
        "sky_overcast",
        "{ file: \"sky_harmonics.exr\", rotate: { axis: [0, 0, 1], degrees: 70 } }",
        Vec::new(),
        &["The same under a sky without a sun, which BSDF sampling finds well."],
    );
    add(
        "sky_turned",
        "{ file: \"sky.exr\", rotate: { axis: [0.48, -0.6, 0.64], degrees: 40 }, scale: 0.5 }",
        vec![Light::Point { position: dvec3(-1.5, 2.5, 1.5), power: [60.0, 50.0, 40.0] }],
        &[
            "The same under a sky that is turned about a slanted axis, with a point light: the environment is one of two",
            "lights.",
        ],
    );
}

/// A plane of two materials.
fn gloss(collection: &mut Collection) {
    let half = |x: [f64; 2]| floor(0.0, x, [-5.0, 3.0]);
    collection.models.push(
        Model::new("sky_gloss", "A plane, one half of which is diffuse, the other glossy")
            .with(Material::diffuse("diffuse", [0.5, 0.5, 0.5]), half([-4.0, 0.0]))
            .with(Material::glossy("glossy", [0.0, 0.0, 0.0], [0.6, 0.6, 0.6], 80.0), half([0.0, 4.0])),
    );
    collection.scenes.push(SceneFile {
        name: "sky_gloss",
        about: &[
            "A diffuse and a glossy half of a plane under a sky with a sun. BSDF sampling is noisy where the sun lights the",
            "diffuse half, samples of the sky are where the glossy half reflects it, both about as much; with balanced",
            "weights, nothing is.",
        ],
        models: vec![ModelUse::plain("sky_gloss")],
        camera: Camera { eye: dvec3(0.0, 2.4, 3.0), center: DVec3::ZERO, fov: 40.0 },
        lights: Vec::new(),
        max_bounces: 1,
    });
    collection.environments.insert("sky_gloss", "{ file: \"sky.exr\" }");
}

/// A room with an open side, lit by the sky and a lamp.
fn room(collection: &mut Collection) {
    let (low, high, back, front) = (0.0, 2.0, -1.5, 2.5);
    let wall = |x: f64, right: DVec3| rectangle(dvec3(x, 1.0, 0.5), 2.0 * right, DVec3::Y);
    collection.models.push(
        Model::new("sky_room", "A room without a front, with a lamp")
            .with(Material::diffuse("floor", [0.6, 0.6, 0.55]), floor(low, [-1.5, 1.5], [back, front]))
            .with(Material::diffuse("ceiling", [0.7, 0.7, 0.7]), ceiling(high, [-1.5, 1.5], [back, front]))
            .with(Material::diffuse("left", [0.65, 0.3, 0.25]), wall(-1.5, DVec3::NEG_Z))
            .with(Material::diffuse("right", [0.3, 0.6, 0.35]), wall(1.5, DVec3::Z))
            .with(
                Material::diffuse("back", [0.7, 0.7, 0.7]),
                rectangle(dvec3(0.0, 1.0, back), 1.5 * DVec3::X, DVec3::Y),
            )
            .with(Material::lamp("lamp", [4.0, 3.5, 3.0]), ceiling(1.9, [-0.4, 0.4], [-0.6, 0.2]))
            .with(Material::mirror("ball", [0.9, 0.9, 0.9]), smooth_sphere(dvec3(0.6, 0.42, -0.4), 0.4, 3)),
    );
    collection.scenes.push(SceneFile {
        name: "sky_room",
        about: &[
            "A room that is open towards the camera: most directions of the sky are occluded, and a lamp is the other light.",
        ],
        models: vec![ModelUse::plain("sky_room")],
        camera: Camera { eye: dvec3(0.0, 1.0, 6.0), center: dvec3(0.0, 1.0, 0.0), fov: 32.0 },
        lights: Vec::new(),
        max_bounces: 8,
    });
    collection
        .environments
        .insert("sky_room", "{ file: \"sky.exr\", rotate: { axis: [0, 1, 0], degrees: 180 } }");
}
