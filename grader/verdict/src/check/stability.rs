//! Evidence of the check `stability`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Anomaly;
use crate::number::Float;
use crate::replay::ReplayTarget;

/// Numerical failures in extreme scenes and at extreme densities.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StabilityTest {
    /// The failures, graded ones first.
    pub findings: Vec<StabilityFinding>,
}

/// One numerical failure.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StabilityFinding {
    /// Where it occurs.
    pub place: Place,
    /// How the submission deviates.
    pub deviation: Deviation,
    /// The most frequent cause of such a deviation.
    pub likely_cause: NumericalCause,
    /// True if it costs points; false if it lies outside the graded range.
    pub is_graded: bool,
    /// The first wrong sample.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub first: Option<Anomaly>,
    /// A path to replay if no single sample is wrong.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub replay: Option<ReplayTarget>,
}

/// Where a numerical failure occurs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Place {
    /// In the unchanged room.
    Unchanged,
    /// In the room scaled by 2^n.
    Scaled(i32),
    /// In the room with all emission scaled by 2^n.
    Brightened(i32),
    /// In a scene of `scenes/extreme/`.
    ExtremeScene(String),
    /// At these densities per solid angle.
    Densities {
        /// Density of the light sample.
        light: Float,
        /// Density of the BSDF sample.
        bsdf: Float,
    },
}

/// How a submission deviates from the expected result.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Deviation {
    /// Samples are not radiance.
    Anomalies {
        /// Number of samples that are NaN or infinite.
        non_finite: u64,
        /// Number of samples that are finite but negative.
        negative: u64,
    },
    /// The mean of a region differs from that of the unchanged scene.
    Region {
        /// First and last column, first and last row; `None` for the whole image.
        pixels: Option<[[u32; 2]; 2]>,
        /// Relative difference.
        relative: Float,
        /// Expected value of the first sample that differs.
        expected: Float,
    },
    /// The mean of an extreme scene is wrong.
    Mean {
        /// Mean of the submission.
        found: Float,
        /// The exact mean.
        expected: Float,
        /// Derivation of the exact mean.
        because: String,
    },
    /// The program panics.
    Panic {
        /// Message of the panic.
        message: String,
    },
    /// A path returns a value that is not radiance.
    NoRadiance {
        /// True if the light sample contributes it, false if the BSDF sample does.
        of_light_sample: bool,
        /// The value.
        value: Float,
        /// Number of pairs of densities that fail in this way, and number of pairs tested.
        pairs: [u32; 2],
    },
    /// MIS weights do not sum to one.
    WeightSum {
        /// Sum of the weights.
        sum: Float,
        /// Number of pairs of densities that fail in this way, and number of pairs tested.
        pairs: [u32; 2],
    },
    /// A sample of infinite density contributes, though 1/∞ is 0.
    InfiniteDensityContributes {
        /// Number of pairs of densities that fail in this way, and number of pairs tested.
        pairs: [u32; 2],
    },
}

impl Deviation {
    /// Number of samples that were NaN or infinite, and number of negative ones.
    pub fn anomalies(&self) -> [u64; 2] {
        match self {
            Self::Anomalies { non_finite, negative } => [*non_finite, *negative],
            Self::NoRadiance { pairs: [failed, _], .. } => [u64::from(*failed), 0],
            _ => [0; 2],
        }
    }
}

/// The most frequent cause of a numerical failure.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum NumericalCause {
    /// There is no light to select.
    NoLights,
    /// Whatever the message of the panic says.
    Panic,
    /// 0/0, ∞/∞, or the square root or arc cosine of a number out of range.
    InvalidOperation,
    /// Division by zero, or an overflow.
    DivisionByZeroOrOverflow,
    /// A cosine whose sign is not checked.
    SignOfCosine,
    /// A power of a length overflows or underflows.
    PowerOfLength {
        /// Size of the scene in its own units.
        size: f64,
    },
    /// A fixed epsilon or minimum distance.
    FixedEpsilon {
        /// Size of the scene in its own units.
        size: f64,
        /// True if the epsilon is large compared with the scene, false if it is small.
        is_large: bool,
    },
    /// Radiance is clamped: many samples have exactly the same value.
    ClampedRadiance {
        /// The value.
        limit: Float,
        /// Number of samples with that value.
        samples: u64,
    },
    /// Radiance is clamped or tone-mapped, or an overflow becomes zero.
    LimitedRadiance,
    /// Small contributions are dropped, or underflow.
    DroppedContributions,
    /// A constant is added to radiance or compared with it.
    ConstantInRadiance,
    /// NaN replaced by zero, or a ray with a wrong offset.
    HiddenNanOrOffset,
    /// A limit on radiance, densities or distances.
    Limit,
    /// A ray passes through an occluder, or light is counted twice.
    LeakOrDoubleCount,
    /// 0/0, as in p / (p + q) with both zero.
    BothDensitiesZero,
    /// ∞/∞, as in p / (p + q) with p infinite.
    InfiniteDensity,
    /// 0/0 or 1/0, from a density of zero of the other technique.
    OtherDensityZero,
    /// ∞/∞ after a square or sum of densities overflowed.
    DensityOverflow,
    /// 0/0 after a square of densities underflowed.
    DensityUnderflow,
    /// A quotient or product of densities overflows or underflows.
    DensityRange,
    /// An infinite square or sum of densities is replaced by a weight of one on both sides.
    OverflowPatchedToOne,
    /// The square of a density overflows or underflows, and NaN is replaced by zero.
    DensityNanHidden,
    /// Densities are clamped, or the two techniques use different weights.
    ClampedDensities,
    /// ∞/∞ replaced by one.
    InfinityOverInfinity,
}
