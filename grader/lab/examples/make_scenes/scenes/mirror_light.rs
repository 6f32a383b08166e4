//! Light seen by way of a mirror and of glass.

use glam::{DVec3, dvec3};

use crate::collection::Collection;
use crate::model::{Material, Model};
use crate::scene_file::{Camera, ModelUse, SceneFile};
use crate::shapes::{floor, panel, panel_facing};
use crate::solids::smooth_sphere;

const EYE: DVec3 = dvec3(0.0, 1.7, 6.2);
const MIRROR: DVec3 = dvec3(-1.3, 1.35, -1.5);
const HIGH_LIGHT: DVec3 = dvec3(0.5, 4.1, 0.9);

pub(super) fn add_to(collection: &mut Collection) {
    // At this angle the camera sees the light, which hangs above the picture, in the middle of the mirror.
    let mirror_normal = (EYE - MIRROR).normalize() + (HIGH_LIGHT - MIRROR).normalize();
    let glass_center = dvec3(1.15, 0.77, 0.4);
    // The lower light stands where the ball turns it upside down for the camera.
    let low_light = dvec3(1.75, 1.25, -2.1);
    collection.models.push(
        Model::new("mirror_light", "A mirror, a glass ball and two lights on a diffuse floor")
            .with(Material::diffuse("floor", [0.55, 0.53, 0.5]), floor(0.0, [-5.0, 5.0], [-3.2, 4.5]))
            .with(
                Material::diffuse("back_wall", [0.45, 0.5, 0.56]),
                panel(dvec3(0.0, 2.75, -3.2), DVec3::Z, 5.0, 2.75),
            )
            .with(Material::mirror("mirror", [0.92, 0.92, 0.92]), panel(MIRROR, mirror_normal, 1.05, 1.05))
            .with(Material::glass("glass", 1.5, [1.0, 1.0, 1.0]), smooth_sphere(glass_center, 0.75, 4))
            .with(
                Material::lamp("high_light", [9.0, 8.0, 6.5]),
                panel_facing(HIGH_LIGHT, dvec3(-0.3, 0.4, -0.8), 0.9, 0.65),
            )
            .with(
                Material::lamp("low_light", [1.2, 2.0, 3.6]),
                panel_facing(low_light, glass_center, 0.6, 0.45),
            ),
    );
    collection.scenes.push(SceneFile {
        name: "mirror_light",
        about: &[
            "Two lights that the camera sees in a mirror and through a glass ball.",
            "Next event estimation can do nothing at a mirror or at glass: emission that is hit after such",
            "a bounce counts in full. If it is forgotten, the mirrored light and the caustic are black.",
        ],
        models: vec![ModelUse::plain("mirror_light")],
        camera: Camera { eye: EYE, center: dvec3(0.0, 1.15, 0.0), fov: 40.0 },
        lights: Vec::new(),
        max_bounces: 8,
    });
}
