//! Light sources.
//!
//! A light is asked for a random point of itself ([`Light::sample_direct`]), and, when a path hits it by chance,
//! for what it emits there ([`Light::emission`]). Densities of points are **per area** of the light; to compare
//! them with those of directions is up to the caller.

mod point;
#[cfg(feature = "probe")]
mod scripted;
mod spot;
mod triangle;

use crate::math::{Rgb, Vec3};
use crate::sampler::Sampler;
use crate::scene::Hit;

pub(crate) use point::PointLight;
pub(crate) use spot::SpotLight;
pub(crate) use triangle::TriangleLight;

/// A light source: a point, a spot, or a triangle. Each triangle of an emissive mesh is a light of its own.
#[derive(Clone, Debug)]
pub struct Light {
    index: usize,
    shape: Shape,
    #[cfg(feature = "probe")]
    script: Option<crate::probe::ScriptedLight>,
}

#[derive(Clone, Debug)]
pub(crate) enum Shape {
    Point(PointLight),
    Spot(SpotLight),
    Triangle(TriangleLight),
}

/// A point of a light, as seen from some other point: the result of [`Light::sample_direct`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectSample {
    /// The point on the light, in world space.
    pub point: Vec3,
    /// For a light with an area the radiance that it sends out, W·sr⁻¹·m⁻²; for one without the intensity towards
    /// the asking point, W·sr⁻¹.
    pub intensity: Rgb,
    /// The density per area of the light with which the point was drawn, m⁻²; 1 for a light without an area.
    pub pdf_area: f32,
    /// The cosine between the light's normal and the direction to the asking point, in (0, 1]; 1 for a light
    /// without an area.
    pub cos: f32,
}

/// What a light emits at a point that a path has hit: the result of [`Light::emission`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Emission {
    /// The radiance sent to where the path came from, W·sr⁻¹·m⁻².
    pub radiance: Rgb,
    /// The density per area with which [`Light::sample_direct`] would have drawn this very point, m⁻².
    pub pdf_area: f32,
    /// The cosine between the light's normal and the direction to where the path came from, in (0, 1].
    pub cos: f32,
}

impl Light {
    #[inline]
    pub(crate) fn new(index: usize, shape: Shape) -> Self {
        Self {
            index,
            shape,
            #[cfg(feature = "probe")]
            script: None,
        }
    }

    /// The same light in another place of the list.
    pub(crate) fn renumbered(self, index: usize) -> Self {
        Self { index, ..self }
    }

    /// Draws a random point of this light, as seen from the point `from` (world space).
    ///
    /// `None` if no light goes from there to `from`: behind the light, in its plane, outside of its cone, at no
    /// distance. Then this sample contributes nothing. Whether anything stands between is not looked at:
    /// see [`Scene::occluded`](crate::scene::Scene::occluded).
    #[inline]
    pub fn sample_direct(&self, from: Vec3, sampler: &mut Sampler) -> Option<DirectSample> {
        let sample = |sampler: &mut Sampler| match &self.shape {
            Shape::Point(light) => light.sample_direct(from),
            Shape::Spot(light) => light.sample_direct(from),
            Shape::Triangle(light) => light.sample_direct(from, sampler),
        };
        #[cfg(feature = "probe")]
        let sample = |sampler: &mut Sampler| self.probe_sample(from, || sample(sampler));
        sample(sampler)
    }

    /// What this light emits at `hit` towards the viewer, `hit.wo`.
    ///
    /// To be called with a hit that [`Hit::light`] says is on this light; only lights with an area are ever hit.
    #[inline]
    pub fn emission(&self, hit: &Hit<'_>) -> Emission {
        let emission = match &self.shape {
            Shape::Point(_) | Shape::Spot(_) => Emission { radiance: Rgb::BLACK, pdf_area: 1.0, cos: 1.0 },
            Shape::Triangle(light) => light.emission(hit.wo),
        };
        #[cfg(feature = "probe")]
        let emission = self.probe_emission(hit, emission);
        emission
    }

    /// True if the light has a surface, so that a path can hit it by chance.
    #[inline]
    pub fn has_area(&self) -> bool {
        matches!(self.shape, Shape::Triangle(_))
    }

    /// Its place in [`Scene::lights`](crate::scene::Scene::lights).
    #[inline]
    pub fn index(&self) -> usize {
        self.index
    }

    /// The luminance of its total power Φ, in watts. For a triangle Φ = π · area · radiance.
    #[inline]
    pub fn power(&self) -> f32 {
        match &self.shape {
            Shape::Point(light) => light.power(),
            Shape::Spot(light) => light.power(),
            Shape::Triangle(light) => light.power(),
        }
    }
}
