//! What a light transport algorithm is.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use crate::math::Rgb;
use crate::ray::Ray;
use crate::sampler::Sampler;
use crate::scene::Scene;

/// An estimator of the radiance that arrives along a ray.
pub trait Integrator: Sync {
    /// One sample: a random number whose expectation is the radiance that reaches `ray.origin` from
    /// `ray.direction`, W·sr⁻¹·m⁻².
    ///
    /// All randomness comes from `sampler`; the same sampler gives the same result.
    fn radiance(&self, scene: &Scene, ray: Ray, sampler: &mut Sampler) -> Rgb;
}

/// How a path tracer looks for light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
pub enum Technique {
    /// By hitting it by chance: directions are drawn from the BSDF alone.
    Bsdf,
    /// By next event estimation: shadow rays to points on lights, wherever they can work.
    Nee,
    /// By both at each point, combined by multiple importance sampling.
    Mis,
}

impl Technique {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Bsdf, Self::Nee, Self::Mis];

    /// Its name on command lines and in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Bsdf => "bsdf",
            Self::Nee => "nee",
            Self::Mis => "mis",
        }
    }
}

impl fmt::Display for Technique {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Technique {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        Self::ALL
            .into_iter()
            .find(|technique| technique.name() == name)
            .ok_or_else(|| format!("`{name}` is no technique; there are bsdf, nee, mis"))
    }
}

/// What a path tracer is told when it is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Settings {
    /// How to look for light.
    pub technique: Technique,
    /// The largest number of times that a path is scattered: 0 shows only lights that the camera sees, 1 direct
    /// light only. It counts alike for light that is hit by chance and light reached by a shadow ray.
    pub max_bounces: u32,
}
