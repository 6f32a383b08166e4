//! What is found at the ends of single precision.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Anomaly;
use crate::number::Float;
use crate::replay::ReplayTarget;

/// Everything that is wrong in extreme scenes and at extreme densities.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StabilityTest {
    /// Those that points depend on first.
    pub findings: Vec<StabilityFinding>,
}

/// One thing that is wrong.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StabilityFinding {
    /// Where.
    pub place: Place,
    /// How.
    pub deviation: Deviation,
    /// What most often does that.
    pub likely_cause: NumericalCause,
    /// True if points depend on it; what lies beyond the range that is graded is only remarked on.
    pub is_graded: bool,
    /// The first sample that is wrong.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub first: Option<Anomaly>,
    /// The path that shows it, where no single sample is to blame.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub replay: Option<ReplayTarget>,
}

/// Where something is wrong.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Place {
    /// In the room as it is.
    Unchanged,
    /// In the room 2^n times as large.
    Scaled(i32),
    /// In the room with lights 2^n times as bright.
    Brightened(i32),
    /// In a scene of `scenes/extreme/`.
    ExtremeScene(String),
    /// At these densities per solid angle.
    Densities {
        /// That of the light sample.
        light: Float,
        /// That of the BSDF sample.
        bsdf: Float,
    },
}

/// How something is wrong.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Deviation {
    /// Samples that are not radiance.
    Anomalies {
        /// NaN or infinite.
        non_finite: u64,
        /// Finite but negative.
        negative: u64,
    },
    /// The mean of a region, compared with the scene as it is.
    Region {
        /// First and last column, first and last row; none for the whole image.
        pixels: Option<[[u32; 2]; 2]>,
        /// Relative difference.
        relative: Float,
        /// What the first sample that differs should be.
        expected: Float,
    },
    /// The mean of an extreme scene.
    Mean {
        /// Mean of the submission.
        found: Float,
        /// The exact mean.
        expected: Float,
        /// Why that is exact.
        because: String,
    },
    /// One of the two techniques returns a radiance that is not one.
    NoRadiance {
        /// True for the light sample, false for the BSDF sample.
        of_light_sample: bool,
        /// The radiance.
        value: Float,
        /// Pairs of densities that fail alike, and pairs that were tried.
        pairs: [u32; 2],
    },
    /// Weights that do not sum to one.
    WeightSum {
        /// Their sum.
        sum: Float,
        /// Pairs of densities that fail alike, and pairs that were tried.
        pairs: [u32; 2],
    },
    /// A sample of infinite density contributes, though 1/∞ is 0.
    InfiniteDensityContributes {
        /// Pairs of densities that fail alike, and pairs that were tried.
        pairs: [u32; 2],
    },
}

impl Deviation {
    /// Samples that were NaN or infinite, and negative ones.
    pub fn anomalies(&self) -> [u64; 2] {
        match self {
            Self::Anomalies { non_finite, negative } => [*non_finite, *negative],
            Self::NoRadiance { pairs: [failed, _], .. } => [u64::from(*failed), 0],
            _ => [0; 2],
        }
    }
}

/// What most often makes numbers go wrong like that.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum NumericalCause {
    /// 0/0, ∞/∞, or the square root or arc cosine of a number out of range.
    InvalidOperation,
    /// Division by zero, or an overflow.
    DivisionByZeroOrOverflow,
    /// A cosine whose sign is ignored.
    SignOfCosine,
    /// A square or cube of lengths over- or underflows, in a scene of this size.
    PowerOfLength {
        /// Size of the scene in its own units.
        size: f64,
    },
    /// A fixed epsilon or minimum distance, in a scene of this size.
    FixedEpsilon {
        /// Size of the scene in its own units.
        size: f64,
        /// True if the epsilon is large compared with the scene, false if it is small.
        is_large: bool,
    },
    /// Radiance is clamped to this value, which so many samples have to the last bit.
    ClampedRadiance {
        /// The value.
        limit: Float,
        /// Samples that have it.
        samples: u64,
    },
    /// Radiance is clamped or compressed, or overflow is turned into zero.
    LimitedRadiance,
    /// Small contributions are dropped, or underflow.
    DroppedContributions,
    /// A constant is added to radiance or compared with it.
    ConstantInRadiance,
    /// NaN hidden as zero, or a ray that starts or ends too close.
    HiddenNanOrOffset,
    /// A limit on radiance, densities or distances.
    Limit,
    /// A ray passes through what should stop it, or light is counted twice.
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
    /// A quotient or product of densities over- or underflows.
    DensityRange,
    /// An infinite square or sum of densities is replaced by a weight of one on both sides.
    OverflowPatchedToOne,
    /// The square of a density over- or underflows, and NaN is hidden as zero.
    DensityNanHidden,
    /// Densities are clamped, or weighted differently by the two techniques.
    ClampedDensities,
    /// ∞/∞ turned into one.
    InfinityOverInfinity,
}
