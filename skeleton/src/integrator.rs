//! The interface of light transport algorithms.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use crate::math::Rgb;
use crate::ray::Ray;
use crate::sampler::Sampler;
use crate::scene::Scene;

/// An estimator of the radiance that arrives along a ray.
pub trait Integrator: Sync {
    /// One sample of the radiance that arrives at `ray.origin` from `ray.direction`, W·sr⁻¹·m⁻². Its expected value is
    /// the radiance.
    ///
    /// All randomness comes from `sampler`: equal samplers give equal results.
    fn radiance(&self, scene: &Scene, ray: Ray, sampler: &mut Sampler) -> Rgb;
}

/// How a path tracer finds light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
pub enum Technique {
    /// BSDF sampling only: a path finds light when it happens to hit a light source.
    Bsdf,
    /// Next event estimation for all light it can find; emission on hits for the rest.
    Nee,
    /// BSDF and light samples at each hit point, combined by multiple importance sampling.
    Mis,
}

impl Technique {
    /// All techniques.
    pub const ALL: [Self; 3] = [Self::Bsdf, Self::Nee, Self::Mis];

    /// The name on command lines, in files and in reports.
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
            .ok_or_else(|| format!("unknown technique `{name}`: use bsdf, nee or mis"))
    }
}

/// Settings of a path tracer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Settings {
    /// Technique for finding light.
    pub technique: Technique,
    /// Maximum number of bounces: 0 = emission only, 1 = direct light. The same limit applies to light that is hit and
    /// to light that is sampled.
    pub max_bounces: u32,
}
