//! Convergence curves (error against run time) as data: `judge` measures them, `present` shows them.
//!
//! Each point of a curve comes from many **separate** renderings of one length, each with its own seed: the points of
//! one progressive rendering would be correlated. Time is processor time of the submission's process, summed over its
//! threads. Programs take turns in short jobs, so that other load on the machine affects all of them alike. The first
//! jobs, which calibrate the lengths, are discarded. Errors are relative to the stored reference, whose own noise is
//! subtracted; intervals are bootstrapped over renderings (Celarek et al.: "Quantifying the Error of Light Transport
//! Algorithms", 2019, explains why many short renderings are better). Convergence neither earns nor costs points.
//!
//! For an unbiased program the squared error falls as 1/time: a line of slope −1 in a log–log plot. A curve that
//! flattens shows bias, which no amount of time removes, or random numbers that repeat.

use arty::integrator::Technique;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Scenes measured by default: diffuse with a small light, glossy with a large one, both at once, and very many lights.
pub const DEFAULT_SCENES: [&str; 4] = ["cornell_box", "cornell_box_glossy", "veach_mis", "many_lights"];

/// The result of a convergence measurement.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Convergence {
    /// Number of threads of each program.
    pub threads: usize,
    /// Processor time budget for all measurements together, in seconds.
    pub seconds: f64,
    /// Seed of all random numbers. It determines the pictures, but not the times.
    pub seed: u64,
    /// One panel for each scene and technique.
    pub panels: Vec<Panel>,
    /// Curves that were not measured, with the reason.
    pub left_out: Vec<NotMeasured>,
}

/// A curve that was not measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct NotMeasured {
    /// Name of the program, with the technique if it has several.
    pub program: String,
    /// Name of the scene; empty if this applies to all scenes.
    pub scene: String,
    /// The reason, as a sentence.
    pub why: String,
}

/// The curves of one plot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Panel {
    /// Name of the scene.
    pub scene: String,
    /// Technique of submissions and solution.
    #[schemars(with = "crate::schema::TechniqueName")]
    pub technique: Technique,
    /// Maximum number of bounces.
    pub max_bounces: u32,
    /// Target relative MSE of [`Curve::seconds_to_target`].
    pub target: f64,
    /// Contribution of the reference's own noise to the relative MSE. It has been subtracted.
    pub reference_noise: f64,
    /// The curves: submissions first, then the solution, then BSDF sampling.
    pub curves: Vec<Curve>,
}

/// Which program a curve shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Role {
    /// A submission.
    Submission,
    /// The solution, with the same technique.
    Solution,
    /// BSDF sampling alone.
    Baseline,
}

/// Errors of one program with one technique in one scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Curve {
    /// Name in tables and plots.
    pub name: String,
    /// Which program it shows.
    pub role: Role,
    /// Technique.
    #[schemars(with = "crate::schema::TechniqueName")]
    pub technique: Technique,
    /// One point per rendering length, shortest first.
    pub points: Vec<Point>,
    /// Slope of ln(relative MSE) over ln(seconds), −1 if unbiased. `None` with fewer than four usable points.
    pub slope: Option<Estimate>,
    /// Efficiency 1/(relative MSE × seconds) divided by the solution's, over the longer half of the renderings.
    pub efficiency: Option<Estimate>,
    /// Processor time in seconds to reach the panel's target; `None` if the target was not reached.
    pub seconds_to_target: Option<f64>,
    /// Relative squared bias, from all renderings: the part of the relative MSE that does not fall with time.
    pub relative_bias_squared: Option<Estimate>,
    /// True if the relative squared bias is at least four bootstrap standard deviations above zero.
    pub floor: bool,
    /// Number of samples that were NaN or infinite. They count as black.
    pub non_finite: u64,
}

/// Errors of renderings of one length.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Point {
    /// Samples per pixel of each rendering.
    pub samples: u64,
    /// Number of renderings.
    pub renders: usize,
    /// Processor time of one rendering, in seconds.
    pub seconds: f64,
    /// Relative MSE: mean of (x − r)² / (r² + 0.01).
    pub relative_mse: Estimate,
    /// Relative MSE without the worst 0.1 % of the pixels of each rendering (at least one pixel).
    pub trimmed_relative_mse: Estimate,
    /// MSE: mean of (x − r)², which is squared bias plus variance.
    pub mse: Estimate,
    /// Squared bias, averaged over pixels. The estimator is unbiased, so that it may be negative.
    pub bias_squared: Estimate,
    /// Variance of one rendering, averaged over pixels.
    pub variance: Estimate,
}

/// An estimate with its 95 % bootstrap interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Estimate {
    /// The estimate.
    pub value: f64,
    /// Lower and upper end of the interval.
    pub interval: [f64; 2],
}

/// Image crops of one panel, rendered in equal time.
#[derive(Clone, Debug, PartialEq)]
pub struct Crops {
    /// Name of the scene.
    pub scene: String,
    /// The technique of submissions and solution.
    pub technique: Technique,
    /// Target processor time of each rendering, in seconds; met up to one sample per pixel.
    pub seconds: f64,
    /// One crop per curve, in the panel's order, and the reference last.
    pub list: Vec<Crop>,
}

/// A crop of one picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Crop {
    /// Name of the curve, or `reference`.
    pub name: String,
    /// Samples per pixel; `None` for the reference.
    pub samples: Option<u64>,
    /// Relative MSE of the whole picture; `None` for the reference.
    pub relative_mse: Option<f64>,
    /// Linear radiance of the pixels, row by row from the top.
    pub pixels: Vec<[f64; 3]>,
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
}
