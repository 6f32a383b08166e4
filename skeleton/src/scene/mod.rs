//! Scenes: descriptions, files, and what a ray hits.

mod build;
mod closed;
mod description;
mod features;
#[cfg(feature = "files")]
pub mod file;
mod hit;
mod recorded;
mod scripted;
mod texture;

use crate::accel::Accel;
use crate::camera::Camera;
use crate::environment::Environment;
use crate::light::Light;
use crate::math::{Rgb, Vec2, Vec3};
use crate::probe::{self, ScriptedBsdf};
use crate::ray::Ray;

pub use crate::camera::CameraDescription;
pub use description::*;
pub use features::Features;
pub use hit::Hit;

/// A scene ready for rendering; immutable.
pub struct Scene {
    accel: Accel,
    triangles: Vec<Triangle>,
    /// Normals and texture coordinates, for triangles that have them.
    attributes: Vec<Attributes>,
    surfaces: Vec<Surface>,
    textures: Vec<Texture>,
    lights: Vec<Light>,
    environment: Option<Environment>,
    camera: CameraDescription,
    defaults: Defaults,
    features: Features,
    warnings: Vec<String>,
}

/// The data of a triangle that a hit needs.
struct Triangle {
    vertices: [Vec3; 3],
    /// Unit normal of the front.
    normal: Vec3,
    /// Index into [`Scene::surfaces`].
    surface: u32,
    /// The light on its front: index into [`Scene::lights`], or [`NONE`].
    light: u32,
    /// The light on its back, from a duplicate triangle with the opposite orientation; or [`NONE`].
    back_light: u32,
    /// Index into [`Scene::attributes`], or [`NONE`].
    attributes: u32,
}

/// The index that refers to nothing.
const NONE: u32 = u32::MAX;

struct Attributes {
    normals: Option<[Vec3; 3]>,
    uvs: Option<[Vec2; 3]>,
}

/// A material in the form that hits need.
struct Surface {
    diffuse: Rgb,
    diffuse_map: Option<u32>,
    specular: Specular,
    /// Only in builds for the grader's host.
    script: Option<ScriptedBsdf>,
}

impl Scene {
    /// The nearest surface hit by the ray; `None` if the ray leaves the scene.
    #[inline]
    pub fn intersect(&self, ray: &Ray) -> Option<Hit<'_>> {
        probe::count_ray();
        let hit = self.accel.intersect(ray.origin, ray.direction, f32::INFINITY, ray.exclude);
        let hit = hit.map(|hit| Hit::new(self, ray, hit));
        probe::record(|| recorded::intersect(ray, hit.as_ref()));
        hit
    }

    /// Traces a shadow ray: true if any surface, glass included, lies strictly between a hit and a point (world space), such
    /// as one on a light.
    ///
    /// The surface that was hit and the one that `point` lies on do not count, so no offsets are needed.
    #[inline]
    pub fn occluded(&self, hit: &Hit<'_>, point: Vec3) -> bool {
        probe::count_shadow_ray();
        let origin = hit.leave_towards(point - hit.point);
        let occluded = self.accel.occluded(origin, point, Some(hit.primitive));
        probe::record(|| recorded::occluded(hit, point, occluded));
        occluded
    }

    /// Traces a shadow ray to the environment: true if any surface, glass included, lies in a direction (world space) from a
    /// hit, however far away. The surface that was hit does not count.
    #[inline]
    pub fn occluded_towards(&self, hit: &Hit<'_>, direction: Vec3) -> bool {
        probe::count_shadow_ray();
        let origin = hit.leave_towards(direction);
        let occluded = self.accel.intersect(origin, direction, f32::INFINITY, Some(hit.primitive)).is_some();
        probe::record(|| recorded::occluded_towards(hit, direction, occluded));
        occluded
    }

    /// All lights. [`Light::index`] is the index into this slice.
    #[inline]
    pub fn lights(&self) -> &[Light] {
        &self.lights
    }

    /// The light that arrives from outside of the scene, along rays that hit nothing; `None` if there is none. It is not one
    /// of [`Scene::lights`].
    #[inline]
    pub fn environment(&self) -> Option<&Environment> {
        self.environment.as_ref()
    }

    /// The camera of the scene for an image of the given size in pixels.
    pub fn camera(&self, width: u32, height: u32) -> Camera {
        Camera::new(&self.camera, width, height)
    }

    /// The default settings from the scene file.
    pub fn defaults(&self) -> Defaults {
        self.defaults
    }

    /// The features of the scene.
    pub fn features(&self) -> &Features {
        &self.features
    }

    /// Warnings about the scene: ignored triangles, limits of precision.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }
}
