//! Lights of every kind, of unequal size, colour and power.

use glam::{DVec3, dvec3};

use crate::collection::Collection;
use crate::model::{Material, Model};
use crate::scene_file::{Camera, Light, ModelUse, SceneFile, Step};
use crate::shapes::{Bottom, block, floor, panel, panel_facing};
use crate::solids::smooth_sphere;

/// Height of a pedestal.
const PEDESTAL: f64 = 0.9;

/// Where the pedestals stand, and how they are turned, in degrees.
const PEDESTALS: [(DVec3, f64); 5] = [
    (dvec3(-2.6, 0.0, 0.3), 25.0),
    (dvec3(-1.4, 0.0, -0.9), 12.0),
    (dvec3(0.0, 0.0, -1.3), 45.0),
    (dvec3(1.4, 0.0, -0.9), -12.0),
    (dvec3(2.6, 0.0, 0.3), -25.0),
];

pub(super) fn add_to(collection: &mut Collection) {
    let stage = Model::new("many_lights_stage", "A floor, a wall and three lights with an area")
        .with(Material::diffuse("stage_floor", [0.6, 0.58, 0.55]), floor(0.0, [-6.0, 6.0], [-3.0, 5.0]))
        .with(
            Material::diffuse("stage_wall", [0.55, 0.57, 0.6]),
            panel(dvec3(0.0, 2.75, -3.0), DVec3::Z, 6.0, 2.75),
        )
        .with(
            Material::lamp("tall_lamp", [11.25, 2.25, 4.0]),
            panel_facing(dvec3(-4.2, 1.6, 0.4), dvec3(0.0, 1.0, -0.5), 0.12, 1.1),
        )
        .with(
            Material::lamp("small_lamp", [150.0, 130.0, 95.0]),
            panel_facing(dvec3(-0.7, 3.9, 1.2), dvec3(0.0, 0.5, -0.8), 0.12, 0.12),
        )
        .with(
            Material::lamp("wide_lamp", [0.88, 2.0, 4.0]),
            panel_facing(dvec3(4.3, 2.6, 1.4), dvec3(0.0, 0.6, -0.5), 1.0, 0.7),
        );
    let pedestal = Model::new("pedestal", "A block to put things on").with(
        Material::diffuse("pedestal", [0.68, 0.66, 0.62]),
        block(DVec3::ZERO, dvec3(0.7, PEDESTAL, 0.7), 0.0, Bottom::Open),
    );
    let radius = 0.42;
    let ball = |name, about, material| {
        Model::new(name, about).with(material, smooth_sphere(dvec3(0.0, radius + 0.002, 0.0), radius, 3))
    };
    let diffuse_ball = ball(
        "diffuse_ball",
        "A diffuse ball that rests on the origin",
        Material::diffuse("diffuse_ball", [0.75, 0.72, 0.66]),
    );
    let glossy_ball = ball(
        "glossy_ball",
        "A glossy ball that rests on the origin",
        Material::glossy("glossy_ball", [0.25, 0.2, 0.14], [0.6, 0.55, 0.45], 120.0),
    );
    collection.models.extend([stage, pedestal, diffuse_ball, glossy_ball]);

    let mut models = vec![ModelUse::plain("many_lights_stage")];
    for (index, (foot, degrees)) in PEDESTALS.into_iter().enumerate() {
        let turn = Step::Rotate { axis: DVec3::Y, degrees };
        models.push(ModelUse { model: "pedestal", steps: vec![turn, Step::Translate(foot)] });
        // The middle ball is the largest, and the glossy ones stand between the diffuse ones.
        let model = if index % 2 == 1 { "glossy_ball" } else { "diffuse_ball" };
        let scale = Step::Scale(if index == 2 { 1.2 } else { 0.9 });
        let lift = Step::Translate(foot + DVec3::Y * PEDESTAL);
        models.push(ModelUse { model, steps: vec![scale, lift] });
    }
    collection.scenes.push(SceneFile {
        name: "many_lights",
        about: &[
            "Twelve lights: six triangles of emissive materials, two triangle lights, two point lights and",
            "two spot lights, of unequal size, colour and power.",
            "Shows whether the probability of picking a light is accounted for, in the estimator and in the",
            "weights; and that lights with and without an area may stand side by side.",
        ],
        models,
        camera: Camera { eye: dvec3(0.0, 2.7, 8.2), center: dvec3(0.0, 1.05, 0.0), fov: 46.0 },
        lights: vec![
            Light::Point { position: dvec3(-2.0, 2.3, 1.3), power: [15.0, 20.0, 7.5] },
            Light::Point { position: dvec3(0.9, 0.5, 1.5), power: [12.5, 5.0, 2.0] },
            Light::Spot {
                position: dvec3(1.4, 4.2, 1.2),
                target: dvec3(0.0, 1.3, -1.3),
                inner: 9.0,
                outer: 14.0,
                power: [25.0, 25.0, 27.5],
            },
            Light::Spot {
                position: dvec3(3.2, 3.6, 3.0),
                target: dvec3(2.5, 0.6, 0.3),
                inner: 4.0,
                outer: 22.0,
                power: [30.0, 12.5, 22.5],
            },
            Light::Triangle {
                corners: [dvec3(-2.5, 3.4, -2.2), dvec3(-1.3, 3.2, -2.2), dvec3(-2.0, 3.9, -1.7)],
                radiance: [2.5, 12.5, 7.5],
            },
            Light::Triangle {
                corners: [dvec3(1.9, 3.3, -2.2), dvec3(2.4, 3.3, -2.2), dvec3(2.2, 3.7, -1.9)],
                radiance: [22.5, 15.0, 3.75],
            },
        ],
        max_bounces: 6,
    });
}
