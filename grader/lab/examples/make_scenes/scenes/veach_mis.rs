//! Plates of rising gloss under lights of rising size, after E. Veach, "Robust Monte Carlo Methods for Light
//! Transport Simulation" (1997), figure 9.2; the numbers are our own.

use glam::{DVec3, dvec3};

use crate::collection::Collection;
use crate::model::{Material, Model};
use crate::number::snap;
use crate::scene_file::{Camera, ModelUse, SceneFile};
use crate::shapes::{floor, panel, tessellated_rectangle};
use crate::solids::icosphere;

const EYE: DVec3 = dvec3(0.0, 4.0, 16.0);

/// The lights stand in a row along x through this point.
pub(crate) const ROW: DVec3 = dvec3(0.0, 3.2, -0.5);

/// Each light: name, place in the row, radius, tint with a mean of one.
const LIGHTS: [(&str, f64, f64, [f64; 3]); 4] = [
    ("light_smallest", -3.0, 0.06, [1.15, 0.97, 0.88]),
    ("light_small", -1.2, 0.18, [1.08, 1.04, 0.88]),
    ("light_large", 0.8, 0.4, [0.9, 1.05, 1.05]),
    ("light_largest", 3.0, 0.8, [0.9, 0.97, 1.13]),
];

/// Power of each light in watts.
const POWER: f64 = 45.0;

/// Each plate: name, height and depth of its centre, half of its width, Phong exponent. The glossiest is the
/// one farthest from the camera.
pub(crate) const PLATES: [(&str, [f64; 2], f64, f64); 5] = [
    ("plate_sharpest", [1.45, 0.4], 3.6, 20_000.0),
    ("plate_sharp", [1.0, 1.7], 3.3, 3_500.0),
    ("plate_middle", [0.66, 3.0], 3.0, 700.0),
    ("plate_soft", [0.42, 4.4], 2.7, 150.0),
    ("plate_softest", [0.26, 5.9], 2.4, 30.0),
];

/// The normal at which a plate mirrors the row of lights towards the camera: half-way between the two.
pub(crate) fn mirroring_normal(center: DVec3) -> DVec3 {
    ((ROW - center).normalize() + (EYE - center).normalize()).normalize()
}

pub(super) fn add_to(collection: &mut Collection) {
    let mut model =
        Model::new("veach_mis", "Five plates, four spheres that emit equal power, floor and wall");
    for (name, [y, z], half_width, exponent) in PLATES {
        let center = dvec3(0.0, y, z);
        let plate = panel(center, mirroring_normal(center), half_width, 0.48);
        let material = Material::glossy(name, [0.03, 0.04, 0.05], [0.8, 0.8, 0.8], exponent);
        model = model.with(material, plate);
    }
    for (name, x, radius, tint) in LIGHTS {
        let sphere = icosphere(ROW + dvec3(x, 0.0, 0.0), radius, 1);
        // Φ = π·A·L, with A as tessellated.
        let radiance = POWER / (std::f64::consts::PI * sphere.area());
        model = model.with(Material::lamp(name, tint.map(|channel| snap(channel * radiance))), sphere);
    }
    // As many triangles as one of the spheres has: then a light picked at random is as often one of these.
    let fill = tessellated_rectangle(dvec3(0.0, 9.0, 9.0), DVec3::X * 2.5, dvec3(0.0, -0.6, 1.2), 10, 4);
    model = model
        .with(Material::lamp("fill", [0.9, 0.9, 0.9]), fill)
        .with(Material::diffuse("floor", [0.4, 0.4, 0.4]), floor(0.0, [-8.0, 8.0], [-3.0, 11.0]))
        .with(
            Material::diffuse("back_wall", [0.45, 0.43, 0.4]),
            panel(dvec3(0.0, 4.0, -3.0), DVec3::Z, 8.0, 4.0),
        );
    collection.models.push(model);
    collection.scenes.push(SceneFile {
        name: "veach_mis",
        about: &[
            "Four lights of equal power and rising size, mirrored in five plates of falling gloss.",
            "Next event estimation fails for large lights in glossy plates (upper right), BSDF sampling",
            "for small lights in rough plates (lower left); multiple importance sampling for none.",
        ],
        models: vec![ModelUse::plain("veach_mis")],
        camera: Camera { eye: EYE, center: dvec3(0.0, 1.0, 2.0), fov: 30.0 },
        lights: Vec::new(),
        max_bounces: 4,
    });
}
