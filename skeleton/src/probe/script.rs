//! Scripts: known answers in place of sampled ones.

use crate::math::{Rgb, Vec3};

/// A BSDF whose values and densities are given, one pair for each of up to three groups of directions above the horizon.
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
    /// Value and density near the sampled direction; `None` if they are those of all directions.
    pub at_target: Option<ScriptedValue>,
    /// Value and density near the direction to the viewer; `None` if they are those of all directions.
    pub at_viewer: Option<ScriptedValue>,
    /// What [`Bsdf::sample`](crate::bsdf::Bsdf::sample) returns.
    pub sampling: ScriptedSampling,
}

/// Value and density of a scripted BSDF.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScriptedValue {
    /// The value in 1/sr.
    pub f: Rgb,
    /// The density per solid angle. Greater than 0.
    pub pdf: f32,
}

/// What a scripted BSDF returns when it is sampled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ScriptedSampling {
    /// The direction to its target.
    Target,
    /// The direction to its target as a sample of a delta lobe, with the value `at_target`, although the BSDF is no delta
    /// distribution. Its value and density near that direction are those of all directions.
    DeltaLobe,
    /// Nothing.
    Nothing,
}

/// A light with known answers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScriptedLight {
    /// The sampled point on a triangle light, in world space.
    pub point: Vec3,
    /// The density per area reported for every sampled point of a triangle light. Greater than 0.
    pub pdf_area: f32,
    /// The density per area reported for every point of a triangle light that a path hits. Greater than 0.
    pub pdf_area_on_hit: f32,
    /// The only point (world space) towards which light samples are not black; `None` if they are black towards none.
    pub bright_from: Option<Vec3>,
}

/// Cosine above which a direction counts as near another one.
const NEAR: f32 = 0.9995;

/// Distance within which a shading point is the one that a light is bright from, in scene units.
const SAME_POINT: f32 = 1e-2;

impl ScriptedBsdf {
    #[inline]
    pub(crate) fn target(&self) -> Vec3 {
        self.target
    }

    #[inline]
    pub(crate) fn is_delta(&self) -> bool {
        self.is_delta
    }

    #[inline]
    pub(crate) fn samples_delta(&self) -> bool {
        self.is_delta || self.sampling == ScriptedSampling::DeltaLobe
    }

    #[inline]
    pub(crate) fn samples_nothing(&self) -> bool {
        self.sampling == ScriptedSampling::Nothing
    }

    /// Value and density of the sampled direction.
    #[inline]
    pub(crate) fn sampled(&self) -> (Rgb, f32) {
        self.at_target.map_or((self.f, self.pdf), |it| (it.f, it.pdf))
    }

    /// Value and density of `wi`, where `to_target` is the sampled direction and `wo` the direction to the viewer.
    #[inline]
    pub(crate) fn of_direction(&self, wi: Vec3, to_target: Vec3, wo: Vec3) -> (Rgb, f32) {
        match (self.at_target, self.at_viewer) {
            _ if self.is_delta => (Rgb::BLACK, 0.0),
            (Some(it), _) if self.sampling == ScriptedSampling::Target && wi.dot(to_target) > NEAR => {
                (it.f, it.pdf)
            }
            (_, Some(it)) if wi.dot(wo) > NEAR => (it.f, it.pdf),
            _ => (self.f, self.pdf),
        }
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

    #[inline]
    pub(crate) fn pdf_area_on_hit(&self) -> f32 {
        self.pdf_area_on_hit
    }

    #[inline]
    pub(crate) fn is_bright_from(&self, from: Vec3) -> bool {
        self.bright_from.is_none_or(|point| from.distance(point) < SAME_POINT)
    }
}
