//! Scenes at the limits of single precision, each with a known radiance: `scenes/extreme/` and its `answers.yml`.
//!
//! Everything is grey, so that the answer is one number. Where it is a closed form, the field of view is so narrow that
//! the answer holds for the whole image.

mod answer;
mod formulas;
mod lights;
mod materials;
mod place;
mod shape;

use glam::{DVec3, dvec3};

use crate::collection::Collection;
use crate::model::{Material, Model};
use crate::output::{Content, OutputFile};
use crate::scene_file::{Camera, Light, SceneFile};
use crate::shapes::floor;
use crate::solids::icosphere;
use crate::surface::Surface;

#[cfg(test)]
pub(crate) use answer::Truth;
use answer::{Answer, answers_file};

/// The folder below `scenes/`.
pub(crate) const FOLDER: &str = "extreme";

/// All extreme scenes with their answers.
#[derive(Default)]
pub(crate) struct Extremes {
    /// The scenes with what they are made of.
    pub(crate) collection: Collection,
    /// One for each scene, in the same order.
    pub(crate) answers: Vec<Answer>,
}

impl Extremes {
    fn add(&mut self, scene: SceneFile, answer: Answer) {
        self.collection.scenes.push(scene);
        self.answers.push(answer);
    }

    /// All files to write.
    pub(crate) fn files(&self) -> Vec<OutputFile> {
        let mut files = self.collection.files("../scene.schema.json");
        let content = Content::Text(answers_file(&self.collection.scenes, &self.answers));
        files.push(OutputFile { name: "answers.yml".to_owned(), content });
        files.iter_mut().for_each(|file| file.name = format!("{FOLDER}/{}", file.name));
        files
    }
}

/// The whole collection.
pub(crate) fn all() -> Extremes {
    let mut extremes = Extremes::default();
    lights::add_to(&mut extremes);
    place::add_to(&mut extremes);
    materials::add_to(&mut extremes);
    shape::add_to(&mut extremes);
    extremes
}

/// The reflectance of floors under closed forms.
const FLOOR: f64 = 0.5;

/// Looks at the origin along a slant, at nothing else.
fn narrow_camera() -> Camera {
    Camera { eye: dvec3(0.3, 0.4, 0.5), center: DVec3::ZERO, fov: 0.01 }
}

/// Looks around from near the middle of a hollow body.
fn inside_camera() -> Camera {
    Camera { eye: dvec3(0.3, 0.2, 0.4), center: dvec3(-0.6, -0.3, -1.0), fov: 70.0 }
}

/// A diffuse floor through the origin.
fn floor_model() -> Model {
    Model::new("floor", "A diffuse floor")
        .with(Material::diffuse("floor", [FLOOR; 3]), floor(0.0, [-8.0, 8.0], [-8.0, 8.0]))
}

/// A square that shines down at the origin from the given height: two triangle lights.
fn square_light(height: f64, side: f64, radiance: f64) -> [Light; 2] {
    let corner = |x: f64, z: f64| dvec3(0.5 * side * x, height, 0.5 * side * z);
    let [a, b, c, d] = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    [[a, b, c], [a, c, d]].map(|corners| Light::Triangle { corners, radiance: [radiance; 3] })
}

/// A hollow ball of 320 triangles around the origin, radius 2, its front inside.
fn hollow_ball() -> Surface {
    icosphere(DVec3::ZERO, 2.0, 2).flipped()
}

/// A hollow cube around the origin, its front inside; each face is made by `face(centre, right, up)`.
fn hollow_cube(face: impl Fn(DVec3, DVec3, DVec3) -> Surface) -> Surface {
    let sides = [
        (DVec3::X, DVec3::Y, DVec3::Z),
        (DVec3::NEG_X, DVec3::Z, DVec3::Y),
        (DVec3::Y, DVec3::Z, DVec3::X),
        (DVec3::NEG_Y, DVec3::X, DVec3::Z),
        (DVec3::Z, DVec3::X, DVec3::Y),
        (DVec3::NEG_Z, DVec3::Y, DVec3::X),
    ];
    let faces = sides.into_iter().map(|(outwards, right, up)| face(outwards, right, up).flipped());
    faces.reduce(Surface::joined).expect("a cube has faces")
}

/// Radiance in a furnace of emission L and reflectance r, after up to k bounces.
fn series(radiance: f64, reflectance: f64, bounces: u32) -> f64 {
    (0..=bounces).map(|bounce| radiance * reflectance.powi(bounce as i32)).sum()
}
