//! Jobs that sample directions of an environment.

use arty::math::Vec3;
use serde::{Deserialize, Serialize};

/// Samples directions of a scene's environment, and evaluates the density for others.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DirectionJob {
    /// Index of the scene, in the order of building. It has an environment.
    pub scene: u32,
    /// Number of directions to sample, each with random numbers of its own.
    pub samples: u32,
    /// Seed of these random numbers.
    pub seed: u64,
    /// Unit directions, in world space, of which the density is asked for.
    pub directions: Vec<Vec3>,
}

/// The result of a [`DirectionJob`]. Numbers may be any, including NaN.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SampledDirections {
    /// One for each sample; `None` where the submission returned none.
    pub samples: Vec<Option<SampledDirection>>,
    /// The densities per solid angle of the given directions.
    pub densities: Vec<f32>,
}

/// A direction that a submission has sampled.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SampledDirection {
    /// The direction, in world space.
    pub wi: Vec3,
    /// Its density per solid angle, as returned with it.
    pub pdf: f32,
    /// Its density per solid angle, as asked for afterwards.
    pub density: f32,
}
