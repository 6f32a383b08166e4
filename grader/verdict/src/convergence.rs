//! Convergence curves (error against run time) as data: `judge` measures them, `present` shows them.
//!
//! Each point of a curve comes from many **separate** renderings of one length, each with its own seed: the points of
//! one progressive rendering would be correlated (Celarek et al.: "Quantifying the Error of Light Transport
//! Algorithms", 2019). Time is processor time of the program's process, summed over its threads: unlike wall time it
//! does not count the time in which other programs had the processor. Other load still makes it larger, since caches
//! and the units of a core are shared.
//!
//! A measurement consists of **blocks**. Each has the same renderings of all lengths and all programs, which take turns
//! in short jobs, so that a change of the machine's speed affects all programs of a block alike. Intervals are Student's
//! t over the blocks (delete-one-block jackknife). `cargo lab coverage` measures how often they contain the truth.
//!
//! Errors are relative to the stored reference, whose own noise is subtracted. Convergence neither earns nor costs
//! points.

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
    /// Name of the curve that efficiency and cost are relative to; `None` if there is none.
    pub yardstick: Option<String>,
    /// The curves: submissions first, then those they are compared with, the solution, and BSDF sampling.
    pub curves: Vec<Curve>,
}

/// Which program a curve shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Role {
    /// A submission.
    Submission,
    /// A program that submissions are to be compared with.
    Rival,
    /// Measurements from elsewhere: times and errors without intervals.
    External,
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
    /// Slope of ln(relative MSE) over ln(samples): −1 if samples are independent and unbiased. Time less its overhead is
    /// proportional to samples. `None` with fewer than three lengths.
    pub slope: Option<Estimate>,
    /// Efficiency 1/(relative MSE × seconds) divided by the yardstick's, over the longer half of the lengths.
    pub efficiency: Option<Estimate>,
    /// Cost of a sample divided by the yardstick's.
    pub relative_cost: Option<Estimate>,
    /// Processor time in seconds of a rendering with the panel's target error; `None` if the target was not reached.
    pub seconds_to_target: Option<Estimate>,
    /// Time and rays of a rendering as a function of its samples; `None` for [`Role::External`].
    pub cost: Option<Cost>,
    /// Result of the test for bias.
    pub bias: Bias,
    /// True if few renderings make up most of the error. Then no interval of a mean error is known, nor of the time to
    /// reach one, and the median is the better summary.
    pub heavy_tailed: bool,
    /// Number of samples that were NaN or infinite. They count as black.
    pub non_finite: u64,
}

/// Cost of a rendering: overhead + samples per pixel × cost of one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Cost {
    /// Processor time that does not depend on the number of samples, in seconds.
    pub overhead: f64,
    /// Processor time for each sample per pixel, in seconds.
    pub seconds: Estimate,
    /// Rays for each sample per pixel, shadow rays included.
    pub rays: f64,
}

/// Result of the judge's test for bias: screening, and confirmation with fresh seeds (see `judge::statistics`).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Bias {
    /// Not tested here.
    NotTested,
    /// No bias was confirmed.
    NotFound {
        /// Smallest relative bias of the whole image that the test would have detected, if it is finite.
        detectable: Option<f64>,
    },
    /// A bias was confirmed.
    Found {
        /// Its relative mean square over the image: the part of the relative MSE that does not fall with time.
        relative_squared: f64,
    },
}

/// Errors of renderings of one length. Of [`Role::External`], only time and relative MSE are known.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Point {
    /// Samples per pixel of each rendering; 0 if unknown.
    pub samples: u64,
    /// Number of renderings.
    pub renders: usize,
    /// Processor time of one rendering, in seconds.
    pub seconds: f64,
    /// Rays of one rendering, shadow rays included; 0 if unknown.
    pub rays: f64,
    /// Relative MSE: mean of (x − r)² / (r² + 0.01).
    pub relative_mse: Estimate,
    /// Median of the relative MSEs of single renderings, with an exact interval from order statistics that holds for any
    /// distribution. Below the mean if tails are heavy.
    pub median_relative_mse: Option<Estimate>,
    /// Relative MSE without the worst 0.1 % of the pixels of each rendering (at least one pixel).
    pub trimmed_relative_mse: Option<Estimate>,
    /// MSE: mean of (x − r)².
    pub mse: Option<Estimate>,
}

/// An estimate with its 95 % confidence interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Estimate {
    /// The estimate.
    pub value: f64,
    /// Lower and upper end of the interval; both equal to the value if it is unknown.
    pub interval: [f64; 2],
}

impl Estimate {
    /// A value whose interval is unknown.
    pub fn without_interval(value: f64) -> Self {
        Self { value, interval: [value; 2] }
    }

    /// True if the interval is known.
    pub fn has_interval(&self) -> bool {
        self.interval[0] < self.interval[1]
    }

    /// The estimate of a positive quantity whose logarithm is estimated.
    #[must_use]
    pub fn exp(self) -> Self {
        Self { value: self.value.exp(), interval: self.interval.map(f64::exp) }
    }

    /// True if the interval contains the value.
    pub fn holds(&self, value: f64) -> bool {
        self.interval[0] <= value && value <= self.interval[1]
    }
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
