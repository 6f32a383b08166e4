//! Light sources.
//!
//! [`Light::sample_direct`] samples a random point on a light. When a path hits a light instead,
//! [`Hit::emission`](crate::scene::Hit::emission) returns what the light emits there. Densities of points are **per area**
//! of the light; converting them to densities per solid angle is up to the caller.

mod point;
mod recorded;
mod scripted;
mod spot;
mod triangle;

use crate::math::{Rgb, Vec3};
use crate::probe::{self, HitRadiance, ScriptedLight};
use crate::sampler::Sampler;

pub(crate) use point::PointLight;
pub(crate) use recorded::emission as recorded_emission;
pub(crate) use spot::SpotLight;
pub(crate) use triangle::TriangleLight;

/// A light source: a point, a spot, or a triangle. Each triangle of an emissive mesh is a separate light.
#[derive(Clone, Debug)]
pub struct Light {
    index: usize,
    shape: Shape,
    /// Only in builds for the grader's host.
    pub(crate) script: Option<ScriptedLight>,
    /// What paths that hit the light find. Only in builds for the grader's host.
    pub(crate) hit_radiance: HitRadiance,
}

#[derive(Clone, Debug)]
pub(crate) enum Shape {
    Point(PointLight),
    Spot(SpotLight),
    Triangle(TriangleLight),
}

/// A random point on a light, as seen from a shading point: the result of [`Light::sample_direct`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectSample {
    /// The sampled point on the light, in world space.
    pub point: Vec3,
    /// Emission towards the shading point: radiance, W·sr⁻¹·m⁻², for a light with an area; intensity, W·sr⁻¹, for one
    /// without.
    pub emitted: Rgb,
    /// Density per area of the light with which `point` was sampled, m⁻²; 1 for a light without an area.
    pub pdf_area: f32,
    /// Cosine between the light's normal and the direction to the shading point, in (0, 1]; 1 for a light without an
    /// area.
    pub cos_light: f32,
}

/// What a light emits at a point that a path has hit: the result of [`Hit::emission`](crate::scene::Hit::emission).
#[derive(Clone, Copy, Debug)]
pub struct Emission<'a> {
    /// The light that was hit.
    pub light: &'a Light,
    /// Radiance emitted towards the origin of the ray, W·sr⁻¹·m⁻².
    pub radiance: Rgb,
    /// Density per area with which [`Light::sample_direct`] samples the point that was hit, m⁻².
    pub pdf_area: f32,
    /// Cosine between the light's normal and the direction to the origin of the ray, in (0, 1].
    pub cos_light: f32,
}

impl Light {
    #[inline]
    pub(crate) fn new(index: usize, shape: Shape) -> Self {
        let radiance = match &shape {
            Shape::Triangle(light) => light.radiance,
            Shape::Point(_) | Shape::Spot(_) => Rgb::BLACK,
        };
        Self { index, shape, script: None, hit_radiance: HitRadiance::new(radiance) }
    }

    /// The same light at another index.
    pub(crate) fn renumbered(self, index: usize) -> Self {
        Self { index, ..self }
    }

    /// Samples a random point on this light, as seen from the shading point `from` (world space).
    ///
    /// `None` if the light emits nothing from the sampled point towards `from`: the shading point is behind the light, in its
    /// plane, outside its cone, or at distance 0. Such a sample contributes nothing. Visibility is not tested; use
    /// [`Scene::occluded`](crate::scene::Scene::occluded).
    #[inline]
    pub fn sample_direct(&self, from: Vec3, sampler: &mut Sampler) -> Option<DirectSample> {
        probe::count_light_sample();
        let mut sample = match (&self.shape, &self.script) {
            (Shape::Point(light), _) => light.sample_direct(from),
            (Shape::Spot(light), _) => light.sample_direct(from),
            (Shape::Triangle(light), None) => light.sample_direct(from, sampler),
            (Shape::Triangle(light), Some(script)) => script.sample_direct(light, from),
        };
        if let (Some(sample), Some(script)) = (&mut sample, &self.script)
            && !script.is_bright_from(from)
        {
            sample.emitted = Rgb::BLACK;
        }
        probe::record(|| recorded::sample_direct(self, from, sample));
        sample
    }

    /// What this light emits towards the unit direction `wo`, which lies on its front. `None` for a light without an
    /// area, which no path ever hits.
    #[inline]
    pub(crate) fn emission(&self, wo: Vec3) -> Option<Emission<'_>> {
        let Shape::Triangle(light) = &self.shape else { return None };
        Some(Emission {
            light: self,
            radiance: self.hit_radiance.get(light.radiance),
            pdf_area: self.script.map_or(light.pdf_area(), |script| script.pdf_area_on_hit()),
            cos_light: light.cos_towards(wo),
        })
    }

    /// True if the light has an area, so that a path can hit it.
    #[inline]
    pub fn has_area(&self) -> bool {
        matches!(self.shape, Shape::Triangle(_))
    }

    /// The index of this light in [`Scene::lights`](crate::scene::Scene::lights).
    #[inline]
    pub fn index(&self) -> usize {
        self.index
    }

    /// Luminance of the total emitted power Φ, in watts. For a triangle Φ = π · area · radiance.
    #[inline]
    pub fn power(&self) -> f32 {
        match &self.shape {
            Shape::Point(light) => light.power(),
            Shape::Spot(light) => light.power(),
            Shape::Triangle(light) => light.power(),
        }
    }
}
