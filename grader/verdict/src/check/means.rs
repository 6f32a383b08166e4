//! Evidence of the checks that test means.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Result of testing the mean of a picture for bias.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MeanTest {
    /// The region that decided: the biased one, or the whole image if none is.
    pub region: RegionId,
    /// Relative error of its mean; `None` if it should be black.
    pub effect: Option<f64>,
    /// 99 % confidence interval of that error; `None` if it should be black.
    pub interval: Option<[f64; 2]>,
    /// Smallest relative error of the whole image that would have been detected; `None` if there is no such error.
    pub detectable: Option<f64>,
    /// Relative error of the whole image's mean that a pass excludes.
    pub tolerance: f64,
    /// Relative error of the whole image's mean; `None` if it should be black.
    pub whole: Option<Effect>,
    /// For each of 8 × 8 tiles, row by row from the top, its error as a normal deviate (in standard errors).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub z: Vec<f64>,
}

/// Maximum relative error that counts as slight.
pub(super) const SLIGHT: f64 = 0.02;

impl MeanTest {
    /// True if the error of the region that decided may be small, and that of the whole image is.
    ///
    /// The estimate for a region that was selected by its error is larger than the error itself, so that its interval
    /// decides.
    pub(super) fn is_slightly_wrong(&self) -> bool {
        let of_region = self.interval.is_some_and(|[min, max]| min <= SLIGHT && max >= -SLIGHT);
        of_region && self.whole.is_some_and(|whole| whole.relative.abs() <= SLIGHT)
    }
}

/// A relative error with its uncertainty.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Effect {
    /// Estimate of the error.
    pub relative: f64,
    /// Half the width of its 99 % confidence interval.
    pub margin: f64,
}

/// A region of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct RegionId {
    /// The weighted sum over the region.
    pub kind: RegionKind,
    /// First and last column, first and last row; `None` for the whole image.
    pub pixels: Option<[[u32; 2]; 2]>,
}

/// The weighted sum over a region.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RegionKind {
    /// One channel of a tile.
    Channel(Channel),
    /// Luminance of a tile.
    Luminance,
    /// All pixels, weighted by the inverse of their relative variance.
    Weighted,
    /// All tiles, with positive and negative weights.
    Pattern,
}

/// A colour channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[expect(missing_docs, reason = "the names say it")]
pub enum Channel {
    Red,
    Green,
    Blue,
}

/// Result of a white furnace.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FurnaceTest {
    /// Test of the picture that decided: the first biased one, or else the first inconclusive one, or else the last.
    pub test: MeanTest,
    /// Maximum number of bounces of that picture.
    pub max_bounces: u32,
    /// Energy of light after exactly 0, 1, 2, … bounces; empty if it has no closed form per bounce.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub energy: Vec<BounceEnergy>,
}

/// Energy of light after a given number of bounces.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BounceEnergy {
    /// Energy relative to the exact value: 1 is right.
    pub relative: f64,
    /// Half the width of its 99 % confidence interval; `None` if unbounded.
    pub margin: Option<f64>,
}

impl BounceEnergy {
    /// True if [`BounceEnergy::relative`] can be plotted and stored.
    pub fn is_finite(&self) -> bool {
        self.relative.is_finite()
    }
}
