//! A point that sends light into a cone only.

use std::f32::consts::{PI, TAU};

use super::DirectSample;
use crate::math::{Rgb, Vec3, direction};

/// Intensity I₀ up to the inner angle, none from the outer angle on, and between them I₀ · s(t), with t running
/// from 0 to 1 as the **cosine** goes from outer to inner, and s(t) = t² (3 − 2t).
#[derive(Clone, Debug)]
pub(crate) struct SpotLight {
    position: Vec3,
    axis: Vec3,
    cos_inner: f32,
    cos_outer: f32,
    intensity: Rgb,
}

impl SpotLight {
    /// Angles from the axis in degrees. The intensity follows from the power: over the cone's solid angle s has
    /// the mean ½, so that Φ = 2π I₀ (1 − (cos inner + cos outer) / 2).
    pub(crate) fn new(position: Vec3, axis: Vec3, inner: f32, outer: f32, power: Rgb) -> Self {
        let axis = direction(Vec3::ZERO, axis).0;
        let (cos_inner, cos_outer) = (inner.to_radians().cos(), outer.to_radians().cos());
        let mut light = Self { position, axis, cos_inner, cos_outer, intensity: Rgb::WHITE };
        light.intensity = power / light.solid_angle();
        light
    }

    /// The solid angle that full intensity would need for the same power.
    fn solid_angle(&self) -> f32 {
        TAU * (1.0 - 0.5 * (self.cos_inner + self.cos_outer))
    }

    #[inline]
    pub(super) fn sample_direct(&self, from: Vec3) -> Option<DirectSample> {
        let (w, _) = direction(self.position, from);
        let intensity = self.intensity * self.falloff(w.dot(self.axis));
        (!intensity.is_black()).then_some(DirectSample {
            point: self.position,
            intensity,
            pdf_area: 1.0,
            cos: 1.0,
        })
    }

    #[inline]
    fn falloff(&self, cos: f32) -> f32 {
        if cos >= self.cos_inner {
            return 1.0;
        }
        if cos <= self.cos_outer {
            return 0.0;
        }
        let t = (cos - self.cos_outer) / (self.cos_inner - self.cos_outer);
        t * t * (3.0 - 2.0 * t)
    }

    pub(super) fn power(&self) -> f32 {
        self.intensity.luminance() * self.solid_angle().min(4.0 * PI)
    }
}
