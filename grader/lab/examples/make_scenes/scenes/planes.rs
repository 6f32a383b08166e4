//! Lights above diffuse planes: closed forms, and nothing that could blur them.

use glam::{DVec3, dvec3};

use crate::collection::Collection;
use crate::model::{Material, Model};
use crate::scene_file::{Camera, Light, ModelUse, SceneFile};
use crate::shapes::{ceiling, floor, rectangle};
use crate::surface::Surface;

/// How far above the plane the lights are.
const LIGHT_HEIGHT: f64 = 2.0;

/// Looks under the light at the plane. The plane fills the picture, wide or square; the light is not in it.
fn camera() -> Camera {
    Camera { eye: dvec3(0.0, 2.4, 3.0), center: DVec3::ZERO, fov: 40.0 }
}

pub(super) fn add_to(collection: &mut Collection) {
    one_light(collection);
    many_sided_light(collection);
    four_lights(collection);
    tiles(collection);
    two_planes(collection);
    large_light(collection);
}

/// A single light, over the plane that others use as well.
fn one_light(collection: &mut Collection) {
    let plane = floor(0.0, [-4.0, 4.0], [-5.0, 3.0]);
    collection.models.push(
        Model::new("plane", "A diffuse plane").with(Material::diffuse("plane", [0.5, 0.5, 0.5]), plane),
    );
    collection.models.push(Model::new("area_plane_light", "A square light that looks down").with(
        Material::lamp("square_light", [10.0, 10.0, 10.0]),
        ceiling(LIGHT_HEIGHT, [-0.5, 0.5], [-0.5, 0.5]),
    ));
    collection.scenes.push(SceneFile {
        name: "point_plane",
        about: &[
            "A point light of intensity I = color / (4 pi) two units above a diffuse plane.",
            "The irradiance is I cos(angle) / distance^2; the plane shows irradiance * 0.5 / pi.",
        ],
        models: vec![ModelUse::plain("plane")],
        camera: camera(),
        lights: vec![Light::Point { position: DVec3::Y * LIGHT_HEIGHT, power: [100.0, 100.0, 100.0] }],
        max_bounces: 1,
    });
    collection.scenes.push(SceneFile {
        name: "area_plane",
        about: &[
            "A square light of side 1 and radiance 10, two units above a diffuse plane and parallel to it.",
            "The irradiance has a closed form (configuration factors of four rectangles); the light",
            "reflects nothing, so there is no indirect light. The plane shows irradiance * 0.5 / pi.",
        ],
        models: ["plane", "area_plane_light"].map(ModelUse::plain).into(),
        camera: camera(),
        lights: Vec::new(),
        max_bounces: 1,
    });
}

/// A light with five corners, tilted and to one side.
fn many_sided_light(collection: &mut Collection) {
    let center = dvec3(-0.9, 1.7, -0.6);
    let normal = (dvec3(0.4, 0.0, 0.2) - center).normalize();
    let right = normal.cross(DVec3::Y).normalize();
    let up = right.cross(normal);
    let corners = (0..5).map(|corner| {
        let angle = std::f64::consts::TAU * f64::from(corner) / 5.0;
        center + 0.6 * (angle.cos() * right - angle.sin() * up)
    });
    let pentagon = Surface::new(corners.collect(), vec![[0, 1, 2], [0, 2, 3], [0, 3, 4]]);
    collection.models.push(
        Model::new("polygon_plane_light", "A light with five corners")
            .with(Material::lamp("pentagon", [8.0, 6.0, 4.0]), pentagon),
    );
    collection.scenes.push(SceneFile {
        name: "polygon_plane",
        about: &[
            "A tilted light with five corners beside the middle of a diffuse plane.",
            "The irradiance has a closed form (Lambert's sum over the edges of a polygon).",
        ],
        models: ["plane", "polygon_plane_light"].map(ModelUse::plain).into(),
        camera: camera(),
        lights: Vec::new(),
        max_bounces: 1,
    });
}

/// Two lights without an area and two with one, of different powers: what the choice of a light is worth.
fn four_lights(collection: &mut Collection) {
    let facing_down = |x: f64, y: f64, z: f64, half: f64| {
        [dvec3(x - half, y, z - half), dvec3(x + half, y, z - half), dvec3(x, y, z + half)]
    };
    collection.scenes.push(SceneFile {
        name: "four_lights",
        about: &[
            "Four unequal lights over a diffuse plane, two of them with an area; the sum of four closed forms.",
        ],
        models: vec![ModelUse::plain("plane")],
        camera: camera(),
        lights: vec![
            Light::Point { position: dvec3(-1.5, 1.5, 0.5), power: [40.0, 20.0, 10.0] },
            Light::Point { position: dvec3(1.2, 2.5, -1.0), power: [20.0, 60.0, 120.0] },
            Light::Triangle { corners: facing_down(0.8, 1.6, 0.6, 0.4), radiance: [9.0, 9.0, 3.0] },
            Light::Triangle { corners: facing_down(-1.0, 1.9, -1.2, 0.7), radiance: [2.0, 4.0, 4.0] },
        ],
        max_bounces: 1,
    });
}

/// Tiles that differ in their tilt along one side of the picture and in their height along the other.
fn tiles(collection: &mut Collection) {
    let mut surface = Surface::default();
    for row in 0..4 {
        for column in 0..4 {
            let [x, y, z] = [f64::from(column) - 1.5, 0.35 * f64::from(row), f64::from(row) - 1.5];
            let (sin, cos) = (22.0 * f64::from(column)).to_radians().sin_cos();
            let along = dvec3(0.42 * cos, 0.42 * sin, 0.0);
            surface = surface.joined(rectangle(dvec3(x, y, z), along, DVec3::NEG_Z * 0.42));
        }
    }
    collection.models.push(
        Model::new("tiles", "Sixteen small diffuse tiles").with(Material::diffuse("tile", [0.6; 3]), surface),
    );
    collection.scenes.push(SceneFile {
        name: "point_grid",
        about: &[
            "Sixteen tiles under a point light: their tilt differs from column to column, their distance from",
            "row to row. Each shows I cos(angle) / distance^2 * 0.6 / pi.",
        ],
        models: vec![ModelUse::plain("tiles")],
        camera: Camera { eye: dvec3(0.0, 6.0, 0.9), center: dvec3(0.0, 0.4, 0.0), fov: 38.0 },
        lights: vec![Light::Point { position: dvec3(-0.6, 4.0, 0.3), power: [300.0, 200.0, 100.0] }],
        max_bounces: 1,
    });
}

/// Two planes so large that nothing of their edges is seen.
fn two_planes(collection: &mut Collection) {
    let size = [-200.0, 200.0];
    collection.models.push(
        Model::new("parallel_planes", "A floor that emits and a ceiling that does not")
            .with(Material::diffuse("floor", [0.6, 0.5, 0.4]).emitting([1.0; 3]), floor(0.0, size, size))
            .with(Material::diffuse("ceiling", [0.5, 0.7, 0.9]), ceiling(1.0, size, size)),
    );
    collection.scenes.push(SceneFile {
        name: "parallel_planes",
        about: &[
            "Between two diffuse planes of reflectances r1 and r2, of which the lower emits L = 1: it shows",
            "L / (1 - r1 r2), the upper one r2 L / (1 - r1 r2), if paths are long enough. The planes end at 200",
            "times their distance, which takes less than a thousandth from that.",
        ],
        models: vec![ModelUse::plain("parallel_planes")],
        camera: Camera { eye: dvec3(0.0, 0.5, 0.0), center: dvec3(0.6, 0.47, -1.0), fov: 100.0 },
        lights: Vec::new(),
        max_bounces: 8,
    });
}

/// Lights that fill much of what a glossy plane mirrors.
fn large_light(collection: &mut Collection) {
    collection.models.push(
        Model::new("glossy_plane", "A glossy plane below large lights")
            .with(
                Material::glossy("gloss", [0.05; 3], [0.7, 0.6, 0.5], 120.0),
                floor(0.0, [-4.0, 4.0], [-5.0, 3.0]),
            )
            // Unequal and apart, so that the lobe does not see the same everywhere.
            .with(Material::lamp("left_light", [1.0; 3]), ceiling(2.5, [-3.0, -1.1], [-6.0, 1.0]))
            .with(Material::lamp("middle_light", [0.4; 3]), ceiling(2.5, [-0.8, 0.8], [-6.0, 1.0]))
            .with(Material::lamp("right_light", [2.0; 3]), ceiling(2.5, [1.1, 3.0], [-6.0, 1.0])),
    );
    collection.scenes.push(SceneFile {
        name: "glossy_plane",
        about: &[
            "A glossy plane that mirrors large lights: directions of the lobe find them nearly always, while hardly",
            "any point of them lies where the lobe looks. So next event estimation alone is many times as noisy as",
            "multiple importance sampling.",
        ],
        models: vec![ModelUse::plain("glossy_plane")],
        camera: camera(),
        lights: Vec::new(),
        max_bounces: 1,
    });
}
