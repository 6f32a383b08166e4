//! The measurements of the check `sampling`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How a submission samples the directions of environments.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SamplingTest {
    /// The map that decided: the first that is wrong, else the last.
    pub map: SampledMap,
    /// Columns and rows of the map.
    pub size: [u32; 2],
    /// What is wrong; `None` if nothing is.
    pub flaw: Option<SamplingFlaw>,
    /// Number of maps that were tested, this one included.
    pub maps: u32,
    /// The integral of the density over all directions; `None` if it is not finite.
    pub integral: Option<f64>,
    /// Relative variance of luminance / density over samples; `None` if it cannot be computed.
    pub variance: Option<f64>,
    /// Relative variance of luminance / density with uniform directions; `None` if it cannot be computed.
    pub variance_of_uniform: Option<f64>,
}

/// A map of the check `sampling`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SampledMap {
    /// Constant radiance in all directions.
    Constant,
    /// One texel.
    OneTexel,
    /// Texels of very different radiance, some of them black; odd numbers of columns and rows.
    Rough,
    /// One row.
    OneRow,
    /// One column.
    OneColumn,
    /// Light from the rows at the poles only.
    Poles,
    /// Light from the first and last column only.
    Seam,
    /// Colours of equal sums and different luminance.
    Colours,
    /// A map that is rotated.
    Rotated,
    /// One bright texel among a million.
    BrightTexel,
    /// No light.
    Black,
}

/// What is wrong with sampled directions or their density.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SamplingFlaw {
    /// A sampled direction is not a unit vector.
    NoDirection,
    /// A density is NaN or negative, or that of a sample zero or infinite.
    NoDensity,
    /// Directions are sampled although no light arrives from any, or the density is not 0.
    InTheDark,
    /// Only this share of the calls returns a direction.
    NoSample {
        /// Between 0 and 1.
        returned: f64,
    },
    /// For this share of the samples, `pdf` returns another density than `sample`.
    Disagree {
        /// Between 0 and 1.
        share: f64,
        /// The median of the density of `sample` divided by that of `pdf`.
        ratio: f64,
    },
    /// The density does not integrate to 1.
    Integral,
    /// The density of a texel is not that of the sheet.
    Density {
        /// Column of the texel.
        column: u32,
        /// Row of the texel.
        row: u32,
        /// The density divided by that of the sheet.
        ratio: f64,
    },
    /// Texels are not sampled as often as the density says.
    Frequency {
        /// Column of the texel that deviates most.
        column: u32,
        /// Row of the texel.
        row: u32,
        /// Its frequency divided by the expected one.
        ratio: f64,
    },
    /// Within texels, directions are not distributed as the density says.
    WithinTexels,
    /// The estimate of the environment's light is hardly less noisy than with uniform directions.
    Noise,
}
