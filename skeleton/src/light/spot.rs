//! A spot light: a point light limited to a cone.

use std::f32::consts::TAU;

use super::DirectSample;
use crate::math::{Rgb, Vec3, direction_and_distance};

/// Intensity I₀ within the inner angle, 0 beyond the outer angle, and I₀ · s(t) in between, where t goes from 0 to 1 as the
/// **cosine** goes from outer to inner, and s(t) = t² (3 − 2t).
#[derive(Clone, Debug)]
pub(crate) struct SpotLight {
    position: Vec3,
    axis: Vec3,
    /// 1 − cos of the inner angle; more precise than the cosine in a narrow cone.
    inner: f32,
    /// 1 − cos of the outer angle.
    outer: f32,
    intensity: Rgb,
}

impl SpotLight {
    /// Angles are measured from the axis, in degrees. The intensity follows from the power: s has the mean ½ between the two
    /// cones, so that Φ = 2π I₀ (1 − (cos inner + cos outer) / 2).
    pub(crate) fn new(position: Vec3, axis: Vec3, inner: f32, outer: f32, power: Rgb) -> Self {
        let axis = direction_and_distance(Vec3::ZERO, axis).0;
        // 1 − cos x = 2 sin² (x / 2)
        let one_minus_cos = |degrees: f32| 2.0 * (0.5 * degrees).to_radians().sin().powi(2);
        let (inner, outer) = (one_minus_cos(inner), one_minus_cos(outer));
        let mut light = Self { position, axis, inner, outer, intensity: Rgb::WHITE };
        light.intensity = power / light.solid_angle();
        light
    }

    /// The solid angle that has the same power at full intensity.
    fn solid_angle(&self) -> f32 {
        TAU * 0.5 * (self.inner + self.outer)
    }

    #[inline]
    pub(super) fn sample_direct(&self, from: Vec3) -> Option<DirectSample> {
        let (w, distance) = direction_and_distance(self.position, from);
        if distance == 0.0 {
            return None; // at the position of the light there is no direction to it
        }
        // The squared distance of two unit vectors is 2 (1 − cos), accurate for small angles.
        let intensity = self.intensity * self.falloff(0.5 * (w - self.axis).length_squared());
        (!intensity.is_black()).then_some(DirectSample {
            point: self.position,
            emitted: intensity,
            pdf_area: 1.0,
            cos_light: 1.0,
        })
    }

    #[inline]
    fn falloff(&self, one_minus_cos: f32) -> f32 {
        if one_minus_cos <= self.inner {
            return 1.0;
        }
        if one_minus_cos >= self.outer {
            return 0.0;
        }
        let t = (self.outer - one_minus_cos) / (self.outer - self.inner);
        t * t * (3.0 - 2.0 * t)
    }

    pub(super) fn power(&self) -> f32 {
        self.intensity.luminance() * self.solid_angle()
    }
}
