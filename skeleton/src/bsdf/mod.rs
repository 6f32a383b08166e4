//! How surfaces scatter light.
//!
//! A [`Bsdf`] belongs to one hit point and one direction `wo` towards the viewer; everything else is asked about a
//! direction `wi` towards the light. Both are unit vectors in world space that point away from the surface. All
//! densities are per solid angle.
//!
//! Surfaces look the same from both sides, but for glass, whose front is outside.

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
/// It is a weighted choice of one or two lobes: diffuse, modified Phong, mirror, glass. Mirror and glass are delta
/// distributions: they scatter into single directions, which no direction chosen by other means ever meets.
#[derive(Clone, Copy, Debug)]
pub struct Bsdf {
    geometry: LocalGeometry,
    first: Lobe,
    second: Option<Lobe>,
    /// The probability with which `sample` picks the first lobe.
    first_probability: f32,
}

/// A direction drawn by [`Bsdf::sample`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BsdfSample {
    /// The direction drawn: a unit vector in world space, away from the surface.
    pub wi: Vec3,
    /// The value of the BSDF for it, in 1/sr, without the cosine; for a delta lobe the factor on the radiance
    /// divided by `cos`, so that `f · cos / pdf` is right in either case.
    pub f: Rgb,
    /// The density per solid angle with which `wi` was drawn, over all lobes; for a delta lobe the probability of
    /// choosing it and its direction. Finite and greater than 0.
    pub pdf: f32,
    /// The absolute cosine between `wi` and the shading normal.
    pub cos: f32,
    /// True if `wi` comes from a delta lobe. Then no other technique could have found this direction.
    pub is_delta: bool,
}

/// The directions that a lobe refers to.
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
    /// True if light from `wi` arrives on the viewer's side of the surface, as reflection needs it. With
    /// interpolated normals there are two horizons; light must be above both.
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

    /// The sum of two lobes; `first_probability` in (0, 1) is how often `sample` picks the first.
    #[inline]
    pub(crate) fn mixture(
        geometry: LocalGeometry,
        first: Lobe,
        second: Lobe,
        first_probability: f32,
    ) -> Self {
        Self { geometry, first, second: Some(second), first_probability }
    }

    /// The reflectance, if the only lobe is a diffuse one.
    ///
    /// Most surfaces are like that. Their share of the functions below is small enough to be inlined; that of other
    /// lobes is not.
    #[inline]
    fn only_diffuse(&self) -> Option<Rgb> {
        match (self.first, self.second) {
            (Lobe::Diffuse { albedo }, None) => Some(albedo),
            _ => None,
        }
    }

    /// The value f(wo, wi) in 1/sr, without the cosine.
    ///
    /// Black from the horizon down, and black for the delta lobes, in whatever direction.
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

    /// The density per solid angle with which [`sample`](Self::sample) would draw `wi`.
    ///
    /// Zero from the horizon down. Of a mixture with a delta lobe only the other lobe counts, with its share. The
    /// integral over all directions is at most 1; what is missing are delta lobes and samples that came out below
    /// the horizon, for which `sample` gives `None`. A black material keeps the density of white, though nothing is
    /// drawn from it.
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

    /// Draws a direction, roughly in proportion to f · cos.
    ///
    /// `None` if nothing is scattered: the material is black, or the direction drawn lies below the horizon. The
    /// path ends there, with no correction to be made.
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
        if lobe.is_delta() {
            let mut sample = lobe.sample_delta(&self.geometry, sampler)?;
            sample.pdf *= probability;
            return Some(sample);
        }
        self.sample_towards(lobe.sample_direction(&self.geometry, sampler)?)
    }

    /// The sample for a direction that a lobe that is not a delta distribution has drawn.
    #[inline]
    fn sample_towards(&self, wi: Vec3) -> Option<BsdfSample> {
        let (f, pdf) = (self.value(wi), self.density(wi));
        // A density of zero or infinity: below the horizon, or beyond what f32 can hold.
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
