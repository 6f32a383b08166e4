//! A lobe under the grader's control. No normal build has one: see `no_probe.rs`.

use super::{BsdfSample, LocalGeometry};
use crate::math::{Rgb, Vec3, direction_and_distance};
use crate::probe::ScriptedBsdf;

/// A [`ScriptedBsdf`] at a hit point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ScriptedLobe {
    /// The only direction that is sampled.
    pub(super) wi: Vec3,
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

    #[inline]
    pub(super) fn eval(&self) -> Rgb {
        if self.is_delta() { Rgb::BLACK } else { self.script.f() }
    }

    #[inline]
    pub(super) fn pdf(&self) -> f32 {
        if self.is_delta() { 0.0 } else { self.script.pdf() }
    }

    #[inline]
    pub(super) fn sample_delta(&self, geometry: &LocalGeometry) -> Option<BsdfSample> {
        self.is_delta().then(|| BsdfSample {
            wi: self.wi,
            f: self.script.f(),
            pdf: self.script.pdf(),
            cos: geometry.normal.dot(self.wi).abs(),
            is_delta: true,
        })
    }
}
