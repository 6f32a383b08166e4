//! Lights that are tiny, huge, near, numerous, or turned away.

use std::f64::consts::PI;

use glam::{DVec3, dvec3};

use super::formulas::{below_point, below_square, floor_shows};
use super::{Answer, Extremes, floor_model, hollow_cube, inside_camera, narrow_camera, series, square_light};
use crate::model::{Material, Model};
use crate::scene_file::{Camera, Light, ModelUse, SceneFile, Step};
use crate::shapes::rectangle;
use crate::surface::Surface;

const SELDOM_HIT: &str = "a path hits the light less than once in a million times";
const NEVER_HIT: &str = "no path hits a point light";
const LARGE: &str =
    "points of the light that are near enough to matter are drawn less than once in a thousand times";
const TOUCHES: &str =
    "the variance is not finite where a light touches what it lights: 1 / d² is not bounded";

fn floor_scene(
    name: &'static str,
    about: &'static [&'static str],
    lights: impl Into<Vec<Light>>,
) -> SceneFile {
    SceneFile {
        name,
        about,
        models: vec![ModelUse::plain("floor")],
        camera: narrow_camera(),
        lights: lights.into(),
        max_bounces: 1,
    }
}

pub(super) fn add_to(extremes: &mut Extremes) {
    extremes.collection.models.push(floor_model());
    size_and_distance(extremes);
    direction(extremes);
    company(extremes);
    strength(extremes);
}

fn size_and_distance(extremes: &mut Extremes) {
    let square = |height: f64, side: f64, radiance: f64| floor_shows(below_square(height, side, radiance));
    let overhead = "closed form of a parallel square overhead";
    extremes.add(
        floor_scene(
            "light_tiny",
            &["A light with a side of a millionth of its distance."],
            square_light(1.0, 1e-6, 1e12),
        ),
        Answer::radiance(square(1.0, 1e-6, 1e12), overhead).without("bsdf", SELDOM_HIT),
    );
    extremes.add(
        floor_scene(
            "light_small",
            &["A light with a side of a thousandth of its distance."],
            square_light(1.0, 1e-3, 1e6),
        ),
        Answer::radiance(square(1.0, 1e-3, 1e6), overhead).without("bsdf", SELDOM_HIT).judged(),
    );
    extremes.add(
        floor_scene(
            "light_huge",
            &["A light with a side of a thousand times its distance."],
            square_light(1.0, 1e3, 1.0),
        ),
        Answer::radiance(square(1.0, 1e3, 1.0), overhead).without("nee", LARGE),
    );
    let mut near = floor_scene(
        "light_near",
        &["A light of side 1, a ten-thousandth above the floor."],
        square_light(1e-4, 1.0, 1.0),
    );
    near.camera = Camera { eye: dvec3(3e-5, 5e-5, 4e-5), ..narrow_camera() };
    extremes.add(near, Answer::radiance(square(1e-4, 1.0, 1.0), overhead).without("nee", LARGE));

    let emitting = Material::diffuse("cube", [0.5; 3]).emitting([0.5; 3]);
    extremes.collection.models.push(
        Model::new("cube_furnace", "A hollow cube that glows inside").with(emitting, hollow_cube(rectangle)),
    );
    extremes.add(
        SceneFile {
            name: "light_touching",
            about: &["Inside a glowing cube: each light touches four others at right angles."],
            models: vec![ModelUse::plain("cube_furnace")],
            camera: inside_camera(),
            lights: Vec::new(),
            max_bounces: 4,
        },
        Answer::radiance(series(0.5, 0.5, 4), "geometric series of a furnace")
            .without("nee", TOUCHES)
            .judged(),
    );
}

fn direction(extremes: &mut Extremes) {
    let position = dvec3(0.5, 2.0, 0.0);
    let edge = |y: f64, z: f64| dvec3(0.0, y, z);
    let [a, b, c, d] = [edge(0.5, -0.5), edge(1.5, -0.5), edge(1.5, 0.5), edge(0.5, 0.5)];
    let vertical = [[a, b, c], [a, c, d]].map(|corners| Light::Triangle { corners, radiance: [1.0; 3] });
    let point = Light::Point { position, power: [4.0 * PI * 10.0; 3] };
    let lights: Vec<Light> = vertical.into_iter().chain([point]).collect();
    extremes.add(
        floor_scene(
            "light_edge_on",
            &["A light seen from exactly its side, which gives nothing, and a point light."],
            lights,
        ),
        Answer::radiance(floor_shows(below_point(10.0, position)), "closed form of the point light alone")
            .without("bsdf", NEVER_HIT)
            .judged(),
    );

    // A floor at a slant, so that rounding can make the product of two equal unit vectors greater than 1.
    let normal = dvec3(0.36, 0.8, 0.48);
    let right = dvec3(0.8, -0.36, 0.0).normalize() * 3.0;
    let slant = rectangle(DVec3::ZERO, right, normal.cross(right));
    extremes.collection.models.push(
        Model::new("slant", "A diffuse floor at a slant").with(Material::diffuse("slant", [0.5; 3]), slant),
    );
    let mut scene = floor_scene(
        "light_along_normal",
        &[
            "A point light exactly along the normal of a slanted floor: rounding can make the cosine greater than 1.",
        ],
        [Light::Point { position: 2.0 * normal, power: [4.0 * PI * 10.0; 3] }],
    );
    scene.models = vec![ModelUse::plain("slant")];
    scene.camera = Camera { eye: dvec3(-0.5, 1.0, 0.3), ..narrow_camera() };
    extremes.add(
        scene,
        Answer::radiance(floor_shows(10.0 / 4.0), "closed form of a point light")
            .without("bsdf", NEVER_HIT)
            .judged(),
    );
}

/// Tiny lights of one tile, in rows of this many.
const ROW: usize = 32;
const STEP: f64 = 0.01;
const TINY: f64 = 0.001;
const TILES: usize = 8;
const TINY_RADIANCE: f64 = 100.0;

fn tile() -> Surface {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for row in 0..ROW {
        for column in 0..ROW {
            let corner = dvec3(STEP * column as f64, 1.0, STEP * row as f64);
            let first = positions.len();
            positions.extend([corner, corner + TINY * DVec3::X, corner + TINY * DVec3::Z]);
            triangles.push([first, first + 1, first + 2]);
        }
    }
    Surface::new(positions, triangles)
}

fn company(extremes: &mut Extremes) {
    extremes.collection.models.push(
        Model::new("tiny_lights", "1024 tiny lights that shine down")
            .with(Material::lamp("tiny", [TINY_RADIANCE; 3]), tile()),
    );
    let place =
        |tile: usize| dvec3(1.5 + 0.4 * (tile % TILES) as f64, 0.0, 0.4 * (tile / TILES) as f64 - 1.6);
    let tiny: f64 = (0..TILES * TILES)
        .flat_map(|number| tile().positions.into_iter().step_by(3).map(move |corner| corner + place(number)))
        .map(|corner| {
            let middle = corner + TINY / 3.0 * (DVec3::X + DVec3::Z);
            // E = L A cos² / d², with both cosines h / d.
            TINY_RADIANCE * 0.5 * TINY * TINY * middle.y.powi(2) / middle.length_squared().powi(2)
        })
        .sum();
    let mut many =
        floor_scene("lights_many", &["65,536 tiny lights beside a large one."], square_light(2.0, 1.0, 1.0));
    many.models.extend(
        (0..TILES * TILES)
            .map(|tile| ModelUse { model: "tiny_lights", steps: vec![Step::Translate(place(tile))] }),
    );
    extremes.add(
        many,
        Answer::radiance(
            floor_shows(tiny + below_square(2.0, 1.0, 1.0)),
            "closed forms of all lights, added",
        )
        .without("nee", "the large light is picked once in 65,538 times")
        .without("bsdf", "a path hits a tiny light once in some thousand times")
        .within(5e-3),
    );

    let strong = square_light(3.0, 1.0, 1.0).map(|light| match light {
        // Turned round: it shines up, at nothing.
        Light::Triangle { corners: [a, b, c], radiance } => Light::Triangle { corners: [a, c, b], radiance },
        other => other,
    });
    let lights: Vec<Light> = square_light(2.0, 1.0, 1e-9).into_iter().chain(strong).collect();
    extremes.add(
        floor_scene(
            "light_billionth",
            &["What is seen is lit by a billionth of the power in the scene."],
            lights,
        ),
        Answer::radiance(floor_shows(below_square(2.0, 1.0, 1e-9)), "closed form of the weak light"),
    );
}

fn strength(extremes: &mut Extremes) {
    for (name, about, radiance) in [
        ("radiance_1e-20", &["A light of radiance 1e-20."], 1e-20),
        ("radiance_1e20", &["A light of radiance 1e20."], 1e20),
    ] {
        extremes.add(
            floor_scene(name, about, square_light(2.0, 1.0, radiance)),
            Answer::radiance(
                floor_shows(below_square(2.0, 1.0, radiance)),
                "closed form of a parallel square overhead",
            ),
        );
    }
    for (name, radiance) in [("ball_dim", 1e-20), ("ball_bright", 1e20)] {
        let material = Material::diffuse(name, [0.5; 3]).emitting([radiance; 3]);
        extremes
            .collection
            .models
            .push(Model::new(name, "A hollow ball that glows inside").with(material, super::hollow_ball()));
    }
    extremes.add(
        SceneFile {
            name: "radiance_both",
            about: &["Inside a ball that glows with radiance 1e-20, beside one that glows with 1e20."],
            models: vec![
                ModelUse::plain("ball_dim"),
                ModelUse { model: "ball_bright", steps: vec![Step::Translate(5.0 * DVec3::X)] },
            ],
            camera: inside_camera(),
            lights: Vec::new(),
            max_bounces: 4,
        },
        Answer::radiance(series(1e-20, 0.5, 4), "geometric series of a furnace"),
    );
}
