//! A triangle light: constant radiance from every point of its front, in every direction.

use std::f32::consts::PI;

use super::DirectSample;
use crate::accel::point_on;
use crate::math::{Rgb, Vec3, direction_and_distance, warp};
use crate::sampler::Sampler;

#[derive(Clone, Debug)]
pub(crate) struct TriangleLight {
    vertices: [Vec3; 3],
    /// Unit normal of the front.
    pub(super) normal: Vec3,
    area: f32,
    pub(super) radiance: Rgb,
}

impl TriangleLight {
    /// `None` if `f32` cannot represent the area or its reciprocal, the density.
    pub(crate) fn new(vertices: [Vec3; 3], radiance: Rgb) -> Option<Self> {
        let [a, b, c] = vertices.map(Vec3::as_dvec3);
        let cross = (b - a).cross(c - a);
        let length = cross.length();
        let area = (0.5 * length) as f32;
        let normal = (cross / length).as_vec3();
        (area.is_normal() && (1.0 / area).is_normal()).then_some(Self { vertices, normal, area, radiance })
    }

    #[inline]
    pub(super) fn sample_direct(&self, from: Vec3, sampler: &mut Sampler) -> Option<DirectSample> {
        let point = point_on(&self.vertices, warp::triangle(sampler.draw_2d()));
        let (w, _) = direction_and_distance(point, from);
        let cos_light = self.normal.dot(w);
        // At a cosine of zero or a distance of zero nothing arrives.
        (cos_light > 0.0).then(|| DirectSample {
            point,
            emitted: self.radiance,
            pdf_area: self.pdf_area(),
            cos_light: cos_light.min(1.0),
        })
    }

    /// Density of a uniformly sampled point per area.
    #[inline]
    pub(super) fn pdf_area(&self) -> f32 {
        1.0 / self.area
    }

    /// Cosine between the normal and a direction on the front, in (0, 1].
    #[inline]
    pub(super) fn cos_towards(&self, wo: Vec3) -> f32 {
        // For a ray almost in the light's plane it may round to zero; a positive minimum keeps quotients finite.
        self.normal.dot(wo).clamp(f32::MIN_POSITIVE, 1.0)
    }

    pub(super) fn power(&self) -> f32 {
        PI * self.area * self.radiance.luminance()
    }
}
