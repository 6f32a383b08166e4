//! Materials with extreme parameters, in uniform light.

use glam::{DVec3, dvec3};

use super::{Answer, Extremes, hollow_ball, inside_camera, series};
use crate::model::{Material, Model};
use crate::scene_file::{Camera, ModelUse, SceneFile};
use crate::shapes::rectangle;
use crate::solids::icosphere;
use crate::surface::Surface;

/// Long enough for all but a millionth of the light between smooth surfaces.
const MANY_BOUNCES: u32 = 400;

fn scene(
    name: &'static str,
    about: &'static [&'static str],
    models: &[&'static str],
    camera: Camera,
    max_bounces: u32,
) -> SceneFile {
    let models = models.iter().map(|model| ModelUse::plain(model)).collect();
    SceneFile { name, about, models, camera, lights: Vec::new(), max_bounces }
}

pub(super) fn add_to(extremes: &mut Extremes) {
    let surroundings = Material::diffuse("surroundings", [0.0; 3]).emitting([1.0; 3]);
    extremes.collection.models.push(
        Model::new("surroundings", "A black hollow ball that glows inside").with(surroundings, hollow_ball()),
    );
    phong(extremes);
    glass(extremes);
    furnaces(extremes);
    dark(extremes);
}

fn phong(extremes: &mut Extremes) {
    let narrow = "points of the lights within the lobe are drawn less than once in a hundred times";
    for (name, about, exponent) in [
        ("phong_1", &["A Phong lobe of exponent 1, seen along its normal."], 1.0),
        ("phong_1e3", &["A Phong lobe of exponent 1e3, seen along its normal."], 1e3),
        ("phong_1e6", &["A Phong lobe of exponent 1e6, seen along its normal."], 1e6),
    ] {
        let plate = rectangle(DVec3::ZERO, 0.3 * DVec3::X, 0.3 * DVec3::Y);
        let material = Material::glossy("plate", [0.0; 3], [0.5; 3], exponent);
        extremes.collection.models.push(Model::new(name, "A glossy plate").with(material, plate));
        let camera = Camera { eye: DVec3::Z, center: DVec3::ZERO, fov: 0.01 };
        let answer = Answer::radiance(0.5, "seen along its normal, a Phong lobe reflects ks of even light");
        let answer = if exponent > 1.0 { answer.without("nee", narrow) } else { answer };
        extremes.add(scene(name, about, &["surroundings", name], camera, 1), answer);
    }
}

fn glass(extremes: &mut Extremes) {
    let invisible = "clear glass in even light is invisible";
    for (name, about, index) in [
        ("glass_1.0001", &["A glass ball that hardly refracts."], 1.0001),
        ("glass_3", &["A glass ball of index 3."], 3.0),
    ] {
        let ball = icosphere(dvec3(-0.3, -0.15, -0.5), 0.5, 1);
        extremes
            .collection
            .models
            .push(Model::new(name, "A glass ball").with(Material::glass("glass", index, [1.0; 3]), ball));
        extremes.add(
            scene(name, about, &["surroundings", name], inside_camera(), MANY_BOUNCES),
            Answer::radiance(1.0, invisible),
        );
    }
    // Light that enters the top at a grazing angle meets the right side head-on, and what that side reflects leaves by
    // the left one: nothing is trapped, as it would be in a pane.
    let profile = [(-1.0, 0.0), (1.0, 0.0), (0.0, -0.8944)];
    let corner = |index: usize, z: f64| dvec3(profile[index].0, profile[index].1, z);
    let positions = (0..3).flat_map(|index| [corner(index, 0.5), corner(index, -0.5)]).collect();
    let triangles =
        vec![[0, 2, 3], [0, 3, 1], [2, 4, 5], [2, 5, 3], [4, 0, 1], [4, 1, 5], [0, 4, 2], [1, 3, 5]];
    let outside = Surface::new(positions, triangles).flipped();
    let outside = if outside.cross(&outside.triangles[0]).y > 0.0 { outside } else { outside.flipped() };
    extremes
        .collection
        .models
        .push(Model::new("prism", "A prism").with(Material::glass("glass", 1.5, [1.0; 3]), outside));
    let grazing = Camera { eye: dvec3(-1.0, 0.001, 0.0), center: DVec3::ZERO, fov: 0.001 };
    extremes.add(
        scene(
            "glass_grazing",
            &["A glass prism, seen at an angle of a thousandth with its top."],
            &["surroundings", "prism"],
            grazing,
            MANY_BOUNCES,
        ),
        Answer::radiance(1.0, invisible),
    );
    let around = icosphere(DVec3::ZERO, 0.8, 2);
    extremes.collection.models.push(
        Model::new("glass_around", "A glass ball around the camera")
            .with(Material::glass("glass", 1.5, [1.0; 3]), around),
    );
    extremes.add(
        scene(
            "camera_in_glass",
            &["The camera is inside of glass."],
            &["surroundings", "glass_around"],
            inside_camera(),
            MANY_BOUNCES,
        ),
        Answer::radiance(2.25, "inside glass radiance is n² times as great"),
    );
}

fn furnaces(extremes: &mut Extremes) {
    let series_of = "geometric series of a furnace";
    for (name, about, reflectance, bounces) in [
        ("albedo_0", &["A glowing ball that reflects nothing."], 0.0, 8),
        ("albedo_0.999", &["A glowing ball that absorbs a thousandth."], 0.999, 16),
        ("albedo_1", &["A glowing ball that absorbs nothing."], 1.0, 16),
        (
            "bounces_1000",
            &[
                "A thousand bounces. (With a reflectance above 0.95, roulette would let the variance grow from bounce to bounce.)",
            ],
            0.9,
            1000,
        ),
    ] {
        let material = Material::diffuse("ball", [reflectance; 3]).emitting([0.5; 3]);
        extremes
            .collection
            .models
            .push(Model::new(name, "A hollow ball that glows inside").with(material, hollow_ball()));
        let answer = Answer::radiance(series(0.5, reflectance, bounces), series_of);
        extremes.add(
            scene(name, about, &[name], inside_camera(), bounces),
            if bounces <= 16 { answer.judged() } else { answer },
        );
    }
    let material = Material::diffuse("ball", [0.5; 3]).emitting([0.5; 3]);
    let inner = icosphere(dvec3(-0.3, -0.15, -0.5), 0.5, 1);
    extremes.collection.models.push(
        Model::new("all_emitters", "A hollow ball and a ball in it, which both glow")
            .with(material.clone(), hollow_ball().joined(inner)),
    );
    extremes.add(
        scene(
            "all_emitters",
            &["Everything that is seen is a light."],
            &["all_emitters"],
            inside_camera(),
            4,
        ),
        Answer::radiance(series(0.5, 0.5, 4), series_of).judged(),
    );
    extremes
        .collection
        .models
        .push(Model::new("ball_half", "A hollow ball that glows inside").with(material, hollow_ball()));
    for (name, about, size) in [
        ("image_1x1", &["A picture of one pixel."], [1, 1]),
        ("image_4096x1", &["A picture of one row."], [4096, 1]),
    ] {
        extremes.add(
            scene(name, about, &["ball_half"], inside_camera(), 4),
            Answer::radiance(series(0.5, 0.5, 4), series_of).sized(size).judged(),
        );
    }
}

fn dark(extremes: &mut Extremes) {
    for (name, about, reflectance) in [
        ("black_room", &["A black ball around a point light: nothing is lit."], 0.0),
        ("no_lights", &["A grey ball without any light."], 0.5),
    ] {
        extremes.collection.models.push(
            Model::new(name, "A hollow ball")
                .with(Material::diffuse("ball", [reflectance; 3]), hollow_ball()),
        );
        let mut scene = scene(name, about, &[name], inside_camera(), 4);
        if reflectance == 0.0 {
            scene.lights.push(crate::scene_file::Light::Point { position: DVec3::ZERO, power: [10.0; 3] });
        }
        extremes.add(scene, Answer::radiance(0.0, "there is no light to see").judged());
    }
}
