//! The recording of one path of a submission as data: `judge` replays the path, `present` shows the recording.

use arty::integrator::Technique;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::rubric::EmissionOnHit;

/// Identifies a path, in a scene that may be scaled or brightened.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ReplayTarget {
    /// Name of the scene: one of `scenes/` or `scenes/extreme/`, or [`ReplayTarget::ROOM`].
    pub scene: String,
    /// Scale factor of the scene.
    pub scale: f64,
    /// Factor on all emission.
    pub emission: f32,
    /// Technique of the submission.
    #[schemars(with = "crate::schema::TechniqueName")]
    pub technique: Technique,
    /// Maximum number of bounces.
    pub max_bounces: u32,
    /// Whether `Hit::emission` returns emission.
    pub emission_on_hit: EmissionOnHit,
    /// Width and height of the picture in pixels.
    pub size: [u32; 2],
    /// Seed of the rendering.
    pub seed: u64,
    /// Column and row.
    pub pixel: [u32; 2],
    /// Index of the sample.
    pub sample: u64,
}

impl ReplayTarget {
    /// Name of the scene that the check `stability` builds in memory.
    pub const ROOM: &str = "stability-room";
}

/// A recorded path.
#[derive(Clone, Debug, Serialize)]
pub struct ReplayedPath {
    /// Radiance that the path returned.
    #[serde(serialize_with = "numbers")]
    pub radiance: [f32; 3],
    /// Calls of the submission, in order.
    pub calls: Vec<RecordedCall>,
    /// Number of further calls that were not recorded.
    pub left_out: u64,
}

/// A recorded call, with names of materials instead of surface indices.
#[derive(Clone, Debug, Serialize)]
pub struct RecordedCall {
    /// Name of the function, such as `Scene::intersect`; `prints` for a line that the submission prints.
    pub function: String,
    /// Arguments.
    pub given: Vec<NamedValue>,
    /// Result; empty for `None`.
    pub got: Vec<NamedValue>,
}

/// A named value.
#[derive(Clone, Debug, Serialize)]
pub struct NamedValue {
    /// Name of the value.
    pub name: String,
    /// Its components. In JSON, NaN and infinity are strings.
    #[serde(serialize_with = "numbers")]
    pub numbers: Vec<f32>,
    /// Text instead of numbers: the name of a material.
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

impl RecordedCall {
    /// First component of a named part of the result; `None` if there is none.
    pub fn number(&self, name: &str) -> Option<f64> {
        self.got(name)?.first().map(|&value| f64::from(value))
    }

    /// Components of a named part of the result; `None` if there is none.
    pub fn got(&self, name: &str) -> Option<&[f32]> {
        self.got.iter().find(|value| value.name == name).map(|value| value.numbers.as_slice())
    }
}

/// One vertex of a path.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Vertex {
    /// Number of bounces before the vertex.
    pub bounce: u32,
    /// Product of f · cos / pdf over these bounces, without Russian roulette (green channel).
    pub throughput: f64,
    /// Emission of the light that was hit here, if any (green channel).
    pub hit: Option<FoundLight>,
    /// Light sample taken here, if any (green channel).
    pub light_sample: Option<FoundLight>,
}

/// Light found by one of the two techniques.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FoundLight {
    /// Density of the technique that found it, per solid angle; `None` if no other technique could have found it.
    pub density: Option<f64>,
    /// Density of the other technique, per solid angle; `None` if it has none.
    pub other_density: Option<f64>,
    /// MIS weight.
    pub weight: f64,
    /// Contribution to the radiance of the path, without Russian roulette.
    pub contribution: f64,
}
