//! How surfaces scatter light.
//!
//! A [`Bsdf`] belongs to one hit point and one direction `wo` to the viewer; its functions take or return the direction
//! `wi` to the light. Both are unit vectors in world space that point away from the surface. All densities
//! are per solid angle.
//!
//! Surfaces are two-sided, except for glass, whose front is outside.

mod diffuse;
mod fresnel;
mod glass;
mod lobe;
mod mirror;
mod phong;
mod recorded;
mod scripted;

use crate::math::{Rgb, Vec3};
use crate::probe;
use crate::sampler::Sampler;

pub use fresnel::fresnel_dielectric;
pub(crate) use glass::Glass;
pub(crate) use lobe::Lobe;
pub(crate) use phong::Phong;
pub(crate) use scripted::ScriptedLobe;

/// The bidirectional scattering distribution function at a hit point, for a fixed direction `wo` to the viewer.
///
/// It is the sum of one or two lobes: diffuse, modified Phong, mirror, glass. Mirror and glass are delta distributions: they
/// scatter into single directions, which no other sampling technique can find.
#[derive(Clone, Copy, Debug)]
pub struct Bsdf {
    geometry: LocalGeometry,
    first: Lobe,
    second: Option<Lobe>,
    /// Selection probability of the first lobe in `sample`.
    first_probability: f32,
}

/// A direction sampled by [`Bsdf::sample`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BsdfSample {
    /// The sampled direction: a unit vector in world space, pointing away from the surface.
    pub wi: Vec3,
    /// The value of the BSDF for `wi`, 1/sr, without the cosine. For a delta lobe, the fraction of radiance that is scattered,
    /// divided by `cos`, so `f · cos / pdf` is correct in either case.
    pub f: Rgb,
    /// Density per solid angle with which `wi` was sampled, over all lobes. For a delta lobe, the probability of selecting it
    /// and its direction. Finite and greater than 0.
    pub pdf: f32,
    /// Absolute cosine between `wi` and the shading normal.
    pub cos: f32,
    /// True if `wi` comes from a delta lobe: no other sampling technique could have found it.
    pub is_delta: bool,
}

/// The directions at a hit point that lobes depend on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LocalGeometry {
    /// Shading normal, on the viewer's side.
    pub(crate) normal: Vec3,
    /// Geometric normal, on the viewer's side.
    pub(crate) geometric_normal: Vec3,
    /// The direction to the viewer.
    pub(crate) wo: Vec3,
}

impl LocalGeometry {
    /// True if `wi` is on the viewer's side of the surface, so that its light can be reflected. With interpolated normals
    /// there are two horizons, and `wi` must be above both.
    #[inline]
    pub(crate) fn reflects(&self, wi: Vec3) -> bool {
        self.normal.dot(wi) > 0.0 && self.geometric_normal.dot(wi) > 0.0
    }
}

impl Bsdf {
    /// A BSDF of one lobe.
    #[inline]
    pub(crate) fn single(geometry: LocalGeometry, lobe: Lobe) -> Self {
        Self { geometry, first: lobe, second: None, first_probability: 1.0 }
    }

    /// The sum of two lobes; `first_probability` in (0, 1) is the selection probability of the first in `sample`.
    #[inline]
    pub(crate) fn mixture(
        geometry: LocalGeometry,
        first: Lobe,
        second: Lobe,
        first_probability: f32,
    ) -> Self {
        Self { geometry, first, second: Some(second), first_probability }
    }

    /// The albedo if there is only a diffuse lobe.
    ///
    /// Most surfaces are like that, and their part of the functions below is small enough to be inlined; that of other lobes
    /// is not.
    #[inline]
    fn only_diffuse(&self) -> Option<Rgb> {
        match (self.first, self.second) {
            (Lobe::Diffuse { albedo }, None) => Some(albedo),
            _ => None,
        }
    }

    /// The value f(wo, wi), 1/sr, without the cosine.
    ///
    /// Black at and below the horizon. Delta lobes contribute nothing, whatever the direction.
    #[inline]
    pub fn eval(&self, wi: Vec3) -> Rgb {
        let f = self.value(wi);
        probe::record(|| recorded::eval(wi, f));
        f
    }

    #[inline]
    fn value(&self, wi: Vec3) -> Rgb {
        if !self.geometry.reflects(wi) {
            return Rgb::BLACK;
        }
        self.only_diffuse().map_or_else(|| self.eval_lobes(wi), diffuse::eval)
    }

    #[inline(never)]
    fn eval_lobes(&self, wi: Vec3) -> Rgb {
        let mut f = self.first.eval(&self.geometry, wi);
        if let Some(second) = &self.second {
            f += second.eval(&self.geometry, wi);
        }
        f
    }

    /// Density per solid angle with which [`sample`](Self::sample) samples `wi`.
    ///
    /// Zero at and below the horizon. In a mixture with a delta lobe, only the other lobe counts, times its selection
    /// probability. The integral over all directions is at most 1; the rest is the probability of delta lobes and of samples
    /// below the horizon, for which `sample` returns `None`. A black material has the density of a white one, although
    /// `sample` always returns `None` for it.
    #[inline]
    pub fn pdf(&self, wi: Vec3) -> f32 {
        let pdf = self.density(wi);
        probe::record(|| recorded::pdf(wi, pdf));
        pdf
    }

    #[inline]
    fn density(&self, wi: Vec3) -> f32 {
        if !self.geometry.reflects(wi) {
            return 0.0;
        }
        self.only_diffuse().map_or_else(|| self.pdf_of_lobes(wi), |_| diffuse::pdf(&self.geometry, wi))
    }

    #[inline(never)]
    fn pdf_of_lobes(&self, wi: Vec3) -> f32 {
        let mut pdf = self.first_probability * self.first.pdf(&self.geometry, wi);
        if let Some(second) = &self.second {
            pdf += (1.0 - self.first_probability) * second.pdf(&self.geometry, wi);
        }
        pdf
    }

    /// Samples a direction with a density roughly proportional to f · cos.
    ///
    /// `None` if nothing is scattered: the material is black, or the sampled direction is below the horizon. The path ends
    /// there, and no compensation is needed.
    #[inline]
    pub fn sample(&self, sampler: &mut Sampler) -> Option<BsdfSample> {
        let sample = match self.only_diffuse() {
            Some(_) => self.sample_towards(diffuse::sample(&self.geometry, sampler)),
            None => self.sample_lobes(sampler),
        };
        probe::record(|| recorded::sample(sample));
        sample
    }

    #[inline(never)]
    fn sample_lobes(&self, sampler: &mut Sampler) -> Option<BsdfSample> {
        let (lobe, probability) = match &self.second {
            None => (&self.first, 1.0),
            Some(_) if sampler.draw() < self.first_probability => (&self.first, self.first_probability),
            Some(second) => (second, 1.0 - self.first_probability),
        };
        if lobe.samples_delta() {
            let mut sample = lobe.sample_delta(&self.geometry, sampler)?;
            sample.pdf *= probability;
            return Some(sample);
        }
        self.sample_towards(lobe.sample_direction(&self.geometry, sampler)?)
    }

    /// The sample for a direction from a lobe that is not a delta distribution.
    #[inline]
    fn sample_towards(&self, wi: Vec3) -> Option<BsdfSample> {
        let (f, pdf) = (self.value(wi), self.density(wi));
        // Below the horizon the density is zero; extreme lobes may overflow.
        if !(pdf > 0.0 && pdf.is_finite() && f.is_finite()) || f.is_black() {
            return None;
        }
        Some(BsdfSample { wi, f, pdf, cos: self.geometry.normal.dot(wi).abs(), is_delta: false })
    }

    /// True if every lobe is a delta distribution (mirror, glass), so that `eval` and `pdf` are zero everywhere.
    #[inline]
    pub fn is_delta(&self) -> bool {
        self.first.is_delta() && self.second.is_none_or(|second| second.is_delta())
    }
}
