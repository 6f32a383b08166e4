//! One path of a submission with every call that it made, as data: what `judge` follows and `present` shows.

use arty::integrator::Technique;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::rubric::EmissionOnHit;

/// A path by its numbers, in a scene that may have been made larger or brighter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ReplayTarget {
    /// Name of the scene: one of `scenes/` or `scenes/extreme/`, or [`ReplayTarget::ROOM`].
    pub scene: String,
    /// How many times as large it is.
    pub scale: f64,
    /// How many times as bright it is.
    pub emission: f32,
    /// Technique of the submission.
    #[schemars(with = "crate::schema::TechniqueName")]
    pub technique: Technique,
    /// Maximum number of bounces.
    pub max_bounces: u32,
    /// Whether lights that are hit emit anything.
    pub emission_on_hit: EmissionOnHit,
    /// Width and height of the picture in pixels.
    pub size: [u32; 2],
    /// Seed of the rendering.
    pub seed: u64,
    /// Column and row.
    pub pixel: [u32; 2],
    /// Number of the sample.
    pub sample: u64,
}

impl ReplayTarget {
    /// Name of the scene that the check `stability` makes in memory.
    pub const ROOM: &str = "stability-room";
}

/// A path with every call.
#[derive(Clone, Debug, Serialize)]
pub struct Path {
    /// The radiance that it returned.
    #[serde(serialize_with = "numbers")]
    pub radiance: [f32; 3],
    /// Every call, in order.
    pub calls: Vec<Step>,
    /// Calls beyond those, which were not written down.
    pub left_out: u64,
}

/// One call, with names of materials instead of numbers of surfaces.
#[derive(Clone, Debug, Serialize)]
pub struct Step {
    /// What was called.
    pub function: String,
    /// What it was given.
    pub given: Vec<Named>,
    /// What it gave; nothing for `None`.
    pub got: Vec<Named>,
}

/// A value with its name.
#[derive(Clone, Debug, Serialize)]
pub struct Named {
    /// What it is.
    pub name: String,
    /// Its numbers, written out: JSON has no NaN.
    #[serde(serialize_with = "numbers")]
    pub numbers: Vec<f32>,
    /// Its name, where it is one: that of a material.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub word: Option<String>,
}

/// Numbers as JSON, with `"NaN"`, `"inf"` and `"-inf"` as text.
fn numbers<S: serde::Serializer>(
    values: impl AsRef<[f32]>,
    serializer: S,
) -> std::result::Result<S::Ok, S::Error> {
    #[derive(Serialize)]
    #[serde(untagged)]
    enum Number {
        Finite(f32),
        Other(String),
    }
    serializer.collect_seq(values.as_ref().iter().map(|&value| {
        if value.is_finite() { Number::Finite(value) } else { Number::Other(value.to_string()) }
    }))
}

impl Step {
    /// A number that it gave.
    pub fn number(&self, name: &str) -> Option<f64> {
        self.got(name)?.first().map(|&value| f64::from(value))
    }

    /// What it gave.
    pub fn got(&self, name: &str) -> Option<&[f32]> {
        self.got.iter().find(|value| value.name == name).map(|value| value.numbers.as_slice())
    }
}

/// One vertex of a path.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Vertex {
    /// Bounces before it.
    pub bounce: u32,
    /// The product of f · cos / p over these bounces, without roulette (green).
    pub throughput: f64,
    /// The emission that was hit here and its weight (green).
    pub hit: Option<FoundLight>,
    /// The light sample that was taken here and its weight (green).
    pub light_sample: Option<FoundLight>,
}

/// FoundLight found in one of the two ways.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FoundLight {
    /// Density per solid angle of the technique that found it; none where no other could have.
    pub density: Option<f64>,
    /// That of the other technique.
    pub other_density: Option<f64>,
    /// The weight by which it counts.
    pub weight: f64,
    /// What it adds to the picture, without roulette.
    pub contribution: f64,
}
