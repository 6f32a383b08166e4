//! What is found where means are judged.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The mean of a picture compared with what it should be.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MeanTest {
    /// The region that decided: the one that is biased, or else the whole image.
    pub region: RegionId,
    /// Relative error of its mean; none if it should be black, so that any light is infinitely wrong.
    pub effect: Option<f64>,
    /// 99 % confidence interval of that error.
    pub interval: Option<[f64; 2]>,
    /// Smallest relative error of the whole image that would have been found; none if any could hide.
    pub detectable: Option<f64>,
    /// Relative error of the whole image that a pass excludes.
    pub tolerance: f64,
    /// Relative error of the plain mean of the whole image; none if it should be black.
    pub whole: Option<Effect>,
    /// For each of 8 × 8 tiles, row by row from the top, its error in standard errors, as a normal deviate.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub z: Vec<f64>,
}

/// A relative error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Effect {
    /// Its estimate.
    pub relative: f64,
    /// Half the width of its 99 % confidence interval.
    pub margin: f64,
}

/// A part of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct RegionId {
    /// What is summed over it.
    pub kind: RegionKind,
    /// First and last column, first and last row; none for the whole image.
    pub pixels: Option<[[u32; 2]; 2]>,
}

/// What is summed over a region.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RegionKind {
    /// One channel of a tile.
    Channel(Channel),
    /// Luminance of a tile.
    Luminance,
    /// All pixels, each weighted by how well it is known.
    Weighted,
    /// All tiles, with weights of either sign.
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

/// What is found in a white furnace.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FurnaceTest {
    /// The picture that decided: the first that is wrong, or else the one that is known least.
    pub test: MeanTest,
    /// Maximum number of bounces of that picture.
    pub max_bounces: u32,
    /// Energy of light after 0, 1, 2, … bounces; empty where it has no closed form bounce by bounce.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub energy: Vec<BounceEnergy>,
}

/// Energy of light after a number of bounces.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BounceEnergy {
    /// Relative to the exact value: 1 if it is right.
    pub relative: f64,
    /// Half the width of its 99 % confidence interval; none if it has none.
    pub margin: Option<f64>,
}

impl BounceEnergy {
    /// True where [`BounceEnergy::relative`] can be plotted and stored.
    pub fn is_finite(&self) -> bool {
        self.relative.is_finite()
    }
}
