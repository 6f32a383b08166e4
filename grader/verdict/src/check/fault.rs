//! Faults of a submission, and samples that are not radiance.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::number::Float;
use crate::replay::ReplayTarget;

/// Why a submission gave no valid answer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Fault {
    /// It panicked with this message.
    Panic(String),
    /// It did not answer within this many seconds.
    Timeout(f64),
    /// It did not finish the first part of a job within this many seconds, so that the whole job would have timed out.
    TooSlow(f64),
    /// Its process died with this status.
    Crash(String),
    /// It waited for this many seconds without computing.
    Waiting(f64),
    /// It traced more rays per path than paths of this length can need.
    TooManyRays {
        /// Mean number of rays per path.
        rays: f64,
        /// Number that is enough for a path that samples every light at every bounce.
        enough: f64,
    },
    /// It rendered an image that is not black with fewer rays than that takes.
    TooFewRays,
    /// It started a thread of its own, and was ended for it.
    Threads,
    /// Its answer violated the protocol, as described.
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
            Self::Waiting(seconds) => write!(f, "it waited for {seconds:.0} s without computing"),
            Self::TooManyRays { rays, enough } => {
                write!(f, "it traced {rays:.1} rays per path, where {enough:.0} are enough")
            }
            Self::TooFewRays => write!(f, "it rendered without tracing rays"),
            Self::Threads => write!(f, "it started a thread"),
            Self::Malformed(what) => write!(f, "its answer was not what was asked for ({what})"),
        }
    }
}

/// Samples that are not radiance (NaN, infinite or negative).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Numerics {
    /// Number of samples that were NaN or infinite.
    pub non_finite: u64,
    /// Number of samples that were finite but negative.
    pub negative: u64,
    /// The first such sample.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub first: Option<Anomaly>,
}

/// A sample that is not radiance, or has a wrong value.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Anomaly {
    /// Column and row of the pixel.
    pub pixel: [u32; 2],
    /// Index of the sample.
    pub sample: u64,
    /// Value of the sample.
    pub value: [Float; 3],
    /// Target for replaying its path; `None` if its scene has no name.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub replay: Option<ReplayTarget>,
}

impl Numerics {
    /// True if every sample was finite and not negative.
    pub fn is_clean(&self) -> bool {
        self.non_finite == 0 && self.negative == 0
    }
}
