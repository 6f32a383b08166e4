//! The modified Phong model.
//!
//! Lafortune and Willems, "Using the Modified Phong Reflectance Model for Physically Based Rendering", report
//! CW 197, K.U. Leuven, 1994: f = ks (n + 2) / 2π · cosⁿ α, where α is the angle between `wi` and the
//! reflection of `wo`. The normalization makes the reflectance ks at normal incidence; for other directions part of the lobe
//! is below the horizon, and less is reflected. The model is reciprocal.

use std::f32::consts::FRAC_1_PI;

use super::LocalGeometry;
use crate::math::{Frame, Rgb, Vec3, reflect, warp};
use crate::sampler::Sampler;

#[derive(Clone, Copy, Debug)]
pub(crate) struct Phong {
    pub(crate) reflectance: Rgb,
    pub(crate) exponent: f32,
}

impl Phong {
    #[inline]
    pub(super) fn eval(&self, geometry: &LocalGeometry, wi: Vec3) -> Rgb {
        self.reflectance * ((self.exponent + 2.0) * (0.5 * FRAC_1_PI) * self.power_of_cosine(geometry, wi))
    }

    #[inline]
    pub(super) fn pdf(&self, geometry: &LocalGeometry, wi: Vec3) -> f32 {
        warp::cosine_power_pdf(self.power_of_cosine(geometry, wi), self.exponent)
    }

    /// Samples a direction around the reflection of `wo`; it may be below the horizon.
    #[inline]
    pub(super) fn sample(&self, geometry: &LocalGeometry, sampler: &mut Sampler) -> Vec3 {
        let mirrored = reflect(geometry.wo, geometry.normal);
        let local = warp::cosine_power(sampler.draw_2d(), self.exponent);
        Frame::around(mirrored).to_world(local).normalize()
    }

    #[inline]
    fn power_of_cosine(&self, geometry: &LocalGeometry, wi: Vec3) -> f32 {
        warp::power_of_cosine(reflect(geometry.wo, geometry.normal), wi, self.exponent)
    }
}
