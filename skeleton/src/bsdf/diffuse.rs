//! The Lambertian model: constant reflected radiance in all directions.

use std::f32::consts::FRAC_1_PI;

use super::LocalGeometry;
use crate::math::{Frame, Rgb, Vec3, warp};
use crate::sampler::Sampler;

/// f = ρ / π
#[inline]
pub(super) fn eval(albedo: Rgb) -> Rgb {
    albedo * FRAC_1_PI
}

#[inline]
pub(super) fn pdf(geometry: &LocalGeometry, wi: Vec3) -> f32 {
    warp::cosine_hemisphere_pdf(geometry.normal.dot(wi))
}

#[inline]
pub(super) fn sample(geometry: &LocalGeometry, sampler: &mut Sampler) -> Vec3 {
    Frame::around(geometry.normal).to_world(warp::cosine_hemisphere(sampler.draw_2d()))
}
