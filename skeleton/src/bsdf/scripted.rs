//! A lobe under the grader's control. No normal build has one: see `no_probe.rs`.

use super::{BsdfSample, LocalGeometry};
use crate::math::{Rgb, Vec3, direction_and_distance};
use crate::probe::ScriptedBsdf;

/// A [`ScriptedBsdf`] at a hit point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ScriptedLobe {
    /// The only direction that is sampled.
    wi: Vec3,
    script: ScriptedBsdf,
}

impl ScriptedLobe {
    #[inline]
    pub(crate) fn new(script: ScriptedBsdf, point: Vec3) -> Self {
        let (wi, _) = direction_and_distance(point, script.target());
        Self { wi, script }
    }

    #[inline]
    pub(super) fn is_delta(&self) -> bool {
        self.script.is_delta()
    }

    /// True if its samples are those of a delta lobe.
    #[inline]
    pub(super) fn samples_delta(&self) -> bool {
        self.script.samples_delta()
    }

    #[inline]
    pub(super) fn eval(&self, geometry: &LocalGeometry, wi: Vec3) -> Rgb {
        self.script.of_direction(wi, self.wi, geometry.wo).0
    }

    #[inline]
    pub(super) fn pdf(&self, geometry: &LocalGeometry, wi: Vec3) -> f32 {
        self.script.of_direction(wi, self.wi, geometry.wo).1
    }

    #[inline]
    pub(super) fn sample_direction(&self) -> Option<Vec3> {
        (!self.samples_delta() && !self.script.samples_nothing()).then_some(self.wi)
    }

    #[inline]
    pub(super) fn sample_delta(&self, geometry: &LocalGeometry) -> Option<BsdfSample> {
        let (f, pdf) = self.script.sampled();
        (self.samples_delta() && !self.script.samples_nothing()).then(|| BsdfSample {
            wi: self.wi,
            f,
            pdf,
            cos: geometry.normal.dot(self.wi).abs(),
            is_delta: true,
        })
    }
}
