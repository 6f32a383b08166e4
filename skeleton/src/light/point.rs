//! A point light: the same intensity in all directions.

use std::f32::consts::PI;

use super::DirectSample;
use crate::math::{Rgb, Vec3};

#[derive(Clone, Debug)]
pub(crate) struct PointLight {
    position: Vec3,
    intensity: Rgb,
}

impl PointLight {
    /// I = Φ / 4π
    pub(crate) fn new(position: Vec3, power: Rgb) -> Self {
        Self { position, intensity: power / (4.0 * PI) }
    }

    #[inline]
    pub(super) fn sample_direct(&self, from: Vec3) -> Option<DirectSample> {
        // At the position of the light there is no direction to it.
        (from != self.position).then_some(DirectSample {
            point: self.position,
            emitted: self.intensity,
            pdf_area: 1.0,
            cos_light: 1.0,
        })
    }

    pub(super) fn power(&self) -> f32 {
        4.0 * PI * self.intensity.luminance()
    }
}
