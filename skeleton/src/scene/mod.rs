//! Scenes: what they are made of, what they look like from a ray.

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
use crate::light::Light;
use crate::math::{Rgb, Vec2, Vec3};
use crate::probe::{self, ScriptedBsdf, Switches};
use crate::ray::Ray;

pub use crate::camera::CameraDescription;
pub use description::*;
pub use features::Features;
pub use hit::Hit;

/// A scene, ready to be asked by rays. Nothing in it changes while it is rendered.
pub struct Scene {
    accel: Accel,
    triangles: Vec<Triangle>,
    /// Normals and texture coordinates of those triangles that have them.
    attributes: Vec<Attributes>,
    surfaces: Vec<Surface>,
    textures: Vec<Texture>,
    lights: Vec<Light>,
    camera: CameraDescription,
    defaults: Defaults,
    features: Features,
    warnings: Vec<String>,
    switches: Switches,
}

/// What is needed of a triangle once it is hit.
struct Triangle {
    vertices: [Vec3; 3],
    /// Unit normal of the front.
    normal: Vec3,
    /// Index into [`Scene::surfaces`].
    surface: u32,
    /// The light that its front is: index into [`Scene::lights`], or [`NONE`].
    light: u32,
    /// The light that its back is, if another triangle stood there the other way round.
    back_light: u32,
    /// Index into [`Scene::attributes`], or [`NONE`].
    attributes: u32,
}

/// No such thing, where an index is expected.
const NONE: u32 = u32::MAX;

struct Attributes {
    normals: Option<[Vec3; 3]>,
    uvs: Option<[Vec2; 3]>,
}

/// A material, with what is the same at all of its points worked out.
struct Surface {
    diffuse: Rgb,
    diffuse_map: Option<u32>,
    specular: Specular,
    /// In no build but that of the grader's host.
    script: Option<ScriptedBsdf>,
}

impl Scene {
    /// The nearest surface that the ray hits.
    #[inline]
    pub fn intersect(&self, ray: &Ray) -> Option<Hit<'_>> {
        probe::count_ray();
        let hit = self.accel.intersect(ray.origin, ray.direction, f32::INFINITY, ray.exclude);
        let hit = hit.map(|hit| Hit::new(self, ray, hit));
        probe::record(|| recorded::intersect(ray, hit.as_ref()));
        hit
    }

    /// True if something stands strictly between a hit and a point (world space), such as one on a light.
    ///
    /// Neither the surface that was hit nor the one that `point` lies on counts, nor what is behind them: no
    /// offsets are needed. Everything else does, glass too.
    #[inline]
    pub fn occluded(&self, hit: &Hit<'_>, point: Vec3) -> bool {
        probe::count_shadow_ray();
        let origin = hit.leave_towards(point - hit.point);
        let occluded = self.accel.occluded(origin, point, Some(hit.primitive));
        probe::record(|| recorded::occluded(hit, point, occluded));
        occluded
    }

    /// All lights; [`Light::index`] is the place in this slice.
    #[inline]
    pub fn lights(&self) -> &[Light] {
        &self.lights
    }

    /// The camera of the scene, for an image of the given size.
    pub fn camera(&self, width: u32, height: u32) -> Camera {
        Camera::new(&self.camera, width, height)
    }

    /// Settings that the scene file suggests.
    pub fn defaults(&self) -> Defaults {
        self.defaults
    }

    /// What there is in the scene, and what is not.
    pub fn features(&self) -> &Features {
        &self.features
    }

    /// What the reader of the scene should know: dropped triangles, limits of precision.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }
}
