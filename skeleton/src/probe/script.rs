//! Scripts: known answers in place of sampled ones.

use crate::math::{Rgb, Vec3};

/// A BSDF with the same value and density for all directions above the horizon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScriptedBsdf {
    /// The point (world space) towards which every sampled direction points.
    pub target: Vec3,
    /// The value in 1/sr; for a delta distribution that of the sampled direction, black for all others.
    pub f: Rgb,
    /// The density per solid angle; for a delta distribution the probability of the sampled direction. Greater than 0.
    pub pdf: f32,
    /// True for a delta distribution.
    pub is_delta: bool,
}

/// A triangle light with a single sample point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScriptedLight {
    /// The sampled point on the light, in world space.
    pub point: Vec3,
    /// The density per area reported for every point of the light. Greater than 0.
    pub pdf_area: f32,
}

impl ScriptedBsdf {
    #[inline]
    pub(crate) fn target(&self) -> Vec3 {
        self.target
    }

    #[inline]
    pub(crate) fn f(&self) -> Rgb {
        self.f
    }

    #[inline]
    pub(crate) fn pdf(&self) -> f32 {
        self.pdf
    }

    #[inline]
    pub(crate) fn is_delta(&self) -> bool {
        self.is_delta
    }
}

impl ScriptedLight {
    #[inline]
    pub(crate) fn point(&self) -> Vec3 {
        self.point
    }

    #[inline]
    pub(crate) fn pdf_area(&self) -> f32 {
        self.pdf_area
    }
}
