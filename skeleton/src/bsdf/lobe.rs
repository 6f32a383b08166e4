//! The lobes of a BSDF.

use super::scripted::ScriptedLobe;
use super::{BsdfSample, Glass, LocalGeometry, Phong, diffuse, mirror};
use crate::math::{Rgb, Vec3};
use crate::sampler::Sampler;

/// One term of a BSDF. `eval` and `pdf` expect `wi` above both horizons.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Lobe {
    Diffuse {
        albedo: Rgb,
    },
    Phong(Phong),
    Mirror {
        reflectance: Rgb,
    },
    Glass(Glass),
    /// Only in builds for the grader's host.
    Scripted(ScriptedLobe),
}

impl Lobe {
    #[inline]
    pub(super) fn is_delta(&self) -> bool {
        match self {
            Self::Diffuse { .. } | Self::Phong(_) => false,
            Self::Mirror { .. } | Self::Glass(_) => true,
            Self::Scripted(script) => script.is_delta(),
        }
    }

    /// True if its samples come from `sample_delta`.
    #[inline]
    pub(super) fn samples_delta(&self) -> bool {
        match self {
            Self::Scripted(script) => script.samples_delta(),
            _ => self.is_delta(),
        }
    }

    #[inline]
    pub(super) fn eval(&self, geometry: &LocalGeometry, wi: Vec3) -> Rgb {
        match self {
            Self::Diffuse { albedo } => diffuse::eval(*albedo),
            Self::Phong(phong) => phong.eval(geometry, wi),
            Self::Mirror { .. } | Self::Glass(_) => Rgb::BLACK,
            Self::Scripted(script) => script.eval(geometry, wi),
        }
    }

    #[inline]
    pub(super) fn pdf(&self, geometry: &LocalGeometry, wi: Vec3) -> f32 {
        match self {
            Self::Diffuse { .. } => diffuse::pdf(geometry, wi),
            Self::Phong(phong) => phong.pdf(geometry, wi),
            Self::Mirror { .. } | Self::Glass(_) => 0.0,
            Self::Scripted(script) => script.pdf(geometry, wi),
        }
    }

    /// Samples a direction; `None` for a delta lobe.
    #[inline]
    pub(super) fn sample_direction(&self, geometry: &LocalGeometry, sampler: &mut Sampler) -> Option<Vec3> {
        match self {
            Self::Diffuse { .. } => Some(diffuse::sample(geometry, sampler)),
            Self::Phong(phong) => Some(phong.sample(geometry, sampler)),
            Self::Mirror { .. } | Self::Glass(_) => None,
            Self::Scripted(script) => script.sample_direction(),
        }
    }

    /// Samples the direction of a delta lobe; `None` for any other lobe.
    #[inline]
    pub(super) fn sample_delta(&self, geometry: &LocalGeometry, sampler: &mut Sampler) -> Option<BsdfSample> {
        match self {
            Self::Diffuse { .. } | Self::Phong(_) => None,
            Self::Mirror { reflectance } => mirror::sample(geometry, *reflectance),
            Self::Glass(glass) => glass.sample(geometry, sampler),
            Self::Scripted(script) => script.sample_delta(geometry),
        }
    }
}
