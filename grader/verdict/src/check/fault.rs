//! What a submission can do instead of rendering: faults, and samples that are not radiance.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::number::Float;
use crate::replay::ReplayTarget;

/// What a submission did instead of answering.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Fault {
    /// It panicked, with this message.
    Panic(String),
    /// It did not answer within so many seconds.
    Timeout(f64),
    /// It would not have answered in time: it did not finish the first part of a job within so many seconds.
    TooSlow(f64),
    /// Its process ended, with this status.
    Crash(String),
    /// Its answer was not what was asked for.
    Malformed(String),
}

impl std::fmt::Display for Fault {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Panic(message) => write!(f, "it panicked: {message}"),
            Self::Timeout(seconds) => write!(f, "it did not finish within {seconds:.0} s"),
            Self::TooSlow(seconds) => {
                write!(f, "it did not finish the first eighth of a job within {seconds:.0} s")
            }
            Self::Crash(status) => write!(f, "its process ended early ({status})"),
            Self::Malformed(what) => write!(f, "its answer was not what was asked for ({what})"),
        }
    }
}

/// Samples that are not radiance.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Numerics {
    /// Samples that were NaN or infinite.
    pub non_finite: u64,
    /// Samples that were finite but negative.
    pub negative: u64,
    /// The first of either kind.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub first: Option<Anomaly>,
}

/// One sample that is not radiance, or differs from what it should be.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Anomaly {
    /// Column and row of the pixel.
    pub pixel: [u32; 2],
    /// Number of the sample.
    pub sample: u64,
    /// Its value.
    pub value: [Float; 3],
    /// How to follow its path again, where the scene can be named.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub replay: Option<ReplayTarget>,
}

impl Numerics {
    /// True if every sample was finite and not negative.
    pub fn is_clean(&self) -> bool {
        self.non_finite == 0 && self.negative == 0
    }
}
