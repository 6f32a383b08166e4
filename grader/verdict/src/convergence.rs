//! Error against run time, as data: what `judge` measures and `present` shows.
//!
//! Every point of a curve is many **separate** renderings of one length, each with a seed of its own: the points of
//! one progressive rendering would all share its luck. Time is processor time of the submission's process, over all of
//! its threads; programs take turns in short jobs, so that whatever else the machine does meets all of them; the first
//! jobs, from which the lengths are planned, are left out. Errors are taken against the stored reference, whose own
//! noise is subtracted; intervals are bootstrapped over renderings (Celarek et al.: "Quantifying the Error of Light
//! Transport Algorithms", 2019, on why many short renderings). Nothing here earns or costs points.
//!
//! For an unbiased program the squared error falls as 1/time: a line of slope −1 in log–log. A curve that flattens has
//! a bias, which no time takes away, or random numbers that repeat.

use arty::integrator::Technique;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The scenes that tell most: diffuse with a small light, glossy with a large one, both at once, very many lights.
pub const TELLING_SCENES: [&str; 4] = ["cornell_box", "cornell_box_glossy", "veach_mis", "many_lights"];

/// Everything that was measured.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Convergence {
    /// Threads of each program.
    pub threads: usize,
    /// The processor time that all measurements together were to take, in seconds.
    pub seconds: f64,
    /// The seed of all random numbers; seeds fix the pictures, not the times.
    pub seed: u64,
    /// One for each scene and technique.
    pub panels: Vec<Panel>,
    /// What was not measured, and why.
    pub left_out: Vec<LeftOut>,
}

/// Something that was not measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LeftOut {
    /// The program, and its technique where it has several.
    pub program: String,
    /// The scene; empty for all of them.
    pub scene: String,
    /// Why.
    pub why: String,
}

/// What is drawn into one plot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Panel {
    /// The scene.
    pub scene: String,
    /// The technique of submissions and solution.
    #[schemars(with = "crate::schema::TechniqueName")]
    pub technique: Technique,
    /// The largest number of bounces.
    pub max_bounces: u32,
    /// The relative MSE that [`Curve::seconds_to_target`] is about.
    pub target: f64,
    /// The part of the relative MSE that is the reference's own noise; it is subtracted.
    pub reference_noise: f64,
    /// The curves: submissions first, then the solution, then plain BSDF sampling.
    pub curves: Vec<Curve>,
}

/// Whose curve it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Role {
    /// Of a submission.
    Submission,
    /// Of the solution, with the same technique.
    Solution,
    /// Plain BSDF sampling.
    Baseline,
}

/// The errors of one program, with one technique, in one scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Curve {
    /// What it is called in tables and plots.
    pub name: String,
    /// Whose it is.
    pub role: Role,
    /// The technique.
    #[schemars(with = "crate::schema::TechniqueName")]
    pub technique: Technique,
    /// From the shortest renderings to the longest.
    pub points: Vec<Point>,
    /// The slope of ln(relative MSE) over ln(seconds): −1 is expected. None with fewer than four usable points.
    pub slope: Option<Estimate>,
    /// Its 1/(relative MSE × seconds) divided by the solution's, over the longer half of the renderings.
    pub efficiency: Option<Estimate>,
    /// The processor time after which the relative MSE is the panel's target; None if it did not get there.
    pub seconds_to_target: Option<f64>,
    /// The relative squared bias (the part of the relative MSE that time does not take away), from all renderings.
    pub relative_bias_squared: Option<Estimate>,
    /// True if that is at least four of its bootstrap standard deviations above zero.
    pub floor: bool,
    /// Samples that were NaN or infinite. They count as black.
    pub non_finite: u64,
}

/// The error of renderings of one length.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Point {
    /// Samples of each pixel in each rendering.
    pub samples: u64,
    /// How many renderings there were.
    pub renders: usize,
    /// Processor time of one, in seconds.
    pub seconds: f64,
    /// Mean of (x − r)² / (r² + 0.01).
    pub relative_mse: Estimate,
    /// The same without the worst 0.1 % of the pixels of each rendering (at least one).
    pub trimmed_relative_mse: Estimate,
    /// Mean of (x − r)²: squared bias plus variance.
    pub mse: Estimate,
    /// The squared bias, averaged over pixels. Unbiased, so that it may be negative where there is none.
    pub bias_squared: Estimate,
    /// The variance of one rendering, averaged over pixels.
    pub variance: Estimate,
}

/// A number with its 95 % bootstrap interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Estimate {
    /// The estimate.
    pub value: f64,
    /// The interval.
    pub interval: [f64; 2],
}

/// The crops of one panel.
#[derive(Clone, Debug, PartialEq)]
pub struct Crops {
    /// The scene.
    pub scene: String,
    /// The technique of submissions and solution.
    pub technique: Technique,
    /// Processor time of each rendering, in seconds, as near as whole samples come to it.
    pub seconds: f64,
    /// In the order of the panel's curves, and the reference last.
    pub list: Vec<Crop>,
}

/// A part of one picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Crop {
    /// Whose it is.
    pub name: String,
    /// Samples of each pixel; none for the reference.
    pub samples: Option<u64>,
    /// The relative MSE of the whole picture; none for the reference.
    pub relative_mse: Option<f64>,
    /// Row by row from the top.
    pub pixels: Vec<[f64; 3]>,
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
}
