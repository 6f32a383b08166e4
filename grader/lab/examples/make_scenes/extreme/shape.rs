//! Degenerate triangles, and cameras very close to surfaces.

use std::f64::consts::PI;

use glam::{DVec3, dvec3};

use super::formulas::{below_point, floor_shows};
use super::{Answer, Extremes, hollow_ball, hollow_cube, inside_camera, narrow_camera, series};
use crate::model::{Material, Model};
use crate::scene_file::{Camera, Light, ModelUse, SceneFile};
use crate::shapes::{floor, rectangle, sheet, tessellated_rectangle};
use crate::surface::Surface;

const SERIES: &str = "geometric series of a furnace";
const TOUCHES: &str =
    "the variance is not finite where a light touches what it lights: 1 / d² is not bounded";

/// A needle's width, and how many there are in each face of the cube.
const NEEDLE: f64 = 1e-4;
const NEEDLES: usize = 20;

pub(super) fn add_to(extremes: &mut Extremes) {
    let glowing = || Material::diffuse("glowing", [0.5; 3]).emitting([0.5; 3]);
    let furnace = |name: &'static str, about: &'static [&'static str], camera: Camera| SceneFile {
        name,
        about,
        models: vec![ModelUse::plain(name)],
        camera,
        lights: Vec::new(),
        max_bounces: 4,
    };
    let answer = || Answer::radiance(series(0.5, 0.5, 4), SERIES);
    let mut add = |name, about, surface, camera, answer| {
        extremes
            .collection
            .models
            .push(Model::new(name, "A hollow body that glows inside").with(glowing(), surface));
        extremes.add(furnace(name, about, camera), answer);
    };
    add(
        "needles",
        &["A glowing cube of which each face is cut into strips and needles."],
        hollow_cube(with_needles),
        inside_camera(),
        answer().without("nee", TOUCHES),
    );
    add(
        "degenerate",
        &["A glowing ball with triangles that have no area, and with some that stand there twice."],
        with_rubbish(hollow_ball()),
        inside_camera(),
        answer().judged(),
    );
    add(
        "slit",
        &["A glowing cube, almost closed, seen from outside through a slit."],
        hollow_cube(|outwards, right, up| {
            if outwards == DVec3::Z { with_slit(outwards, right, up) } else { rectangle(outwards, right, up) }
        }),
        Camera { eye: dvec3(0.0, 0.0, 3.0), center: DVec3::ZERO, fov: 0.005 },
        // The slit is a six-thousandth of the walls.
        answer().without("nee", TOUCHES),
    );
    let quartered = |outwards, right, up| tessellated_rectangle(outwards, right, up, 2, 2);
    add(
        "camera_on_surface",
        &["The camera is exactly in a wall of a glowing cube."],
        hollow_cube(quartered),
        Camera { eye: dvec3(0.25, 0.5, 1.0), center: dvec3(0.0, 0.0, -1.0), fov: 70.0 },
        answer().without("nee", TOUCHES),
    );
    add(
        "camera_along_axis",
        &["The camera looks exactly along an axis at where four edges meet."],
        hollow_cube(quartered),
        Camera { eye: DVec3::ZERO, center: DVec3::NEG_Z, fov: 0.0001 },
        answer().without("nee", TOUCHES),
    );

    let position = dvec3(0.4, 1.5, -0.2);
    let light = || Light::Point { position, power: [4.0 * PI * 10.0; 3] };
    let overlapping = floor(0.0, [-8.0, 8.0], [-8.0, 8.0]).joined(floor(0.0, [-3.0, 5.0], [-7.0, 2.0]));
    extremes.collection.models.push(
        Model::new("coplanar", "Two floors in the same plane")
            .with(Material::diffuse("floors", [0.5; 3]), overlapping),
    );
    let mut scene =
        furnace("coplanar", &["Two floors of one material overlap in the same plane."], narrow_camera());
    scene.lights.push(light());
    extremes.add(
        scene,
        Answer::radiance(floor_shows(below_point(10.0, position)), "closed form of a point light")
            .without("bsdf", "no path hits a point light")
            .judged(),
    );

    extremes.collection.models.push(Model::new("empty_mesh", "Nothing at all"));
    let mut scene = furnace("empty_mesh", &["A mesh without triangles and a point light."], inside_camera());
    scene.lights.push(light());
    extremes.add(scene, Answer::radiance(0.0, "there is nothing to see").judged());
}

/// A rectangle cut into strips with needles between them.
fn with_needles(center: DVec3, right: DVec3, up: DVec3) -> Surface {
    let columns = 2 * NEEDLES;
    sheet(columns, 1, |u, v| {
        let column = (u * columns as f64).round() as usize;
        let start = 2.0 / NEEDLES as f64 * (column / 2) as f64 - 1.0;
        let across = if column.is_multiple_of(2) { start } else { start + NEEDLE };
        center + across * right + (2.0 * v - 1.0) * up
    })
}

/// The same with triangles that have no area and with repeated ones, at the end.
fn with_rubbish(mut surface: Surface) -> Surface {
    let some: Vec<[usize; 3]> = surface.triangles.iter().copied().step_by(16).collect();
    for [a, b, c] in some {
        surface.triangles.extend([[a, a, b], [b, b, b], [b, c, a], [a, b, c]]);
    }
    surface
}

/// A rectangle with a horizontal slit through its middle, 0.002 high.
fn with_slit(center: DVec3, right: DVec3, up: DVec3) -> Surface {
    let half = 0.4995;
    rectangle(center + (1.0 - half) * up, right, half * up).joined(rectangle(
        center - (1.0 - half) * up,
        right,
        half * up,
    ))
}
