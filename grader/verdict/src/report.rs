//! What a grade has found. `report.json` holds all of it; every other format is made from that.

use std::collections::BTreeMap;
use std::path::Path;

use arty::integrator::Technique;
use serde::{Deserialize, Serialize};

use crate::convergence::Convergence;
use crate::error::{Error, Result};
use crate::pictures::ImageError;
use crate::rubric::CheckKind;
use crate::sandbox::{Layers, Level, both, missing};
use crate::submission::{BuildFailure, Explanation, IntakeFinding, SourceFinding};

/// The version of the format.
pub const SCHEMA: &str = "arty-report/1";

/// The result of grading one hand-in.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// [`SCHEMA`].
    pub schema: String,
    /// What was graded.
    pub submission: SubmissionInfo,
    /// For which assignment.
    pub assignment: String,
    /// The sums.
    pub points: Points,
    /// Task by task.
    pub tasks: Vec<TaskResult>,
    /// Check by check.
    pub checks: Vec<CheckResult>,
    /// What the scenes made pointless.
    pub left_out: Vec<LeftOut>,
    /// Likely causes, the likeliest first.
    pub diagnosis: Vec<Diagnosis>,
    /// Samples that were no radiance.
    pub numerics: Numerics,
    /// Where the time went.
    pub cost: Cost,
    /// How the hand-in was confined.
    pub sandbox: Sandbox,
    /// What the grade rests on.
    pub provenance: BTreeMap<String, String>,
    /// Error against run time, where it was measured: that begins when the points stand, and changes none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub convergence: Option<Convergence>,
    /// How far a few pictures are from their references, where they were rendered. That changes no points either.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub images: Vec<ImageError>,
}

/// What was graded.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SubmissionInfo {
    /// The path as it was given.
    pub path: String,
    /// BLAKE3 of the source.
    pub hash: String,
    /// Why it does not compile, if it does not. Where there was nothing to compile, this says so, too.
    pub build_failure: Option<BuildFailure>,
    /// Written explanations that came with it, for a person to mark.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub explanations: Vec<Explanation>,
    /// Why there was nothing to compile, with its code.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub refusal: Option<IntakeFinding>,
    /// What was odd when it was taken in. It costs no points.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<IntakeFinding>,
}

/// Sums of points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Points {
    /// Earned in the tasks that are graded automatically.
    pub earned: f64,
    /// What these tasks are worth.
    pub automatic_max: f64,
    /// What the tasks are worth that a person marks.
    pub manual_max: f64,
    /// Both together.
    pub max: f64,
    /// Given by a person so far; none if nobody has marked anything.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub marked: Option<f64>,
    /// Of `automatic_max`, what rests on checks that are left out here because they need the solution.
    #[serde(default)]
    pub elsewhere: f64,
}

/// The points of one task.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TaskResult {
    /// Its number on the sheet.
    pub id: String,
    /// What it is about.
    pub title: String,
    /// Points earned; none yet where a person marks.
    pub points: Option<f64>,
    /// Points for all of it.
    pub max: f64,
    /// Of these, what rests on checks that are left out here because they need the solution.
    #[serde(default)]
    pub elsewhere: f64,
    /// The checks that decide.
    pub checks: Vec<String>,
    /// Why points are missing.
    pub reason: String,
}

/// The outcome of one check.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CheckResult {
    /// What tells it from all others.
    pub id: String,
    /// The kind of check.
    pub check: CheckKind,
    /// The scene.
    pub scene: String,
    /// The task that it decides.
    pub task: String,
    /// The technique that was asked for.
    pub technique: Technique,
    /// The largest number of bounces.
    pub max_bounces: u32,
    /// True if the task earns nothing without it.
    pub evidence: bool,
    /// The outcome.
    pub verdict: Verdict,
    /// Why, as a code.
    pub reason: Reason,
    /// Why, in a sentence.
    pub explanation: String,
    /// The relative error of the mean, in the region that decided.
    pub effect: Option<f64>,
    /// Its 99 % interval.
    pub interval: Option<[f64; 2]>,
    /// The smallest relative error of the whole image that would have been found.
    pub detectable: Option<f64>,
    /// Paths traced.
    pub samples: u64,
    /// Time it took.
    pub seconds: f64,
    /// Samples that were NaN or infinite.
    pub non_finite: u64,
    /// Samples that were negative.
    pub negative: u64,
    /// What was found about the weights, where they were looked at.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub weights: Option<Weights>,
    /// In a furnace: how many times light counts that is scattered 0, 1, 2, … times. Each should be 1.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub coefficients: Vec<f64>,
    /// Half the 99 % interval of each of these.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub coefficient_margins: Vec<f64>,
    /// How noisy the hand-in is, where that was looked at.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub variance_ratios: Vec<VarianceOf>,
    /// What else tells one mistake from another, by name; which names there are is up to the kind of check.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub details: BTreeMap<String, f64>,
    /// What is worth knowing, but costs no points.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub remarks: Vec<String>,
    /// For each of 8 × 8 tiles (row by row from the top) how many standard errors it was off, as normal deviates, where
    /// one picture was judged.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub z: Vec<f64>,
    /// The command that repeats it.
    pub repeat: String,
}

impl CheckResult {
    /// The relative error of the whole image's mean, under the names by which [`Self::whole`] finds it.
    pub fn enter_whole(&mut self, effect: f64, margin: f64) {
        let values = [(WHOLE, effect), (WHOLE_MARGIN, margin)];
        self.details = values
            .into_iter()
            .filter(|(_, value)| value.is_finite())
            .map(|(name, value)| (name.to_owned(), value))
            .collect();
    }

    /// The relative error of the whole image's mean, and half the width of its 99 % interval; none where no picture was
    /// judged, or it should be black.
    pub fn whole(&self) -> Option<[f64; 2]> {
        Some([*self.details.get(WHOLE)?, *self.details.get(WHOLE_MARGIN)?])
    }
}

const WHOLE: &str = "whole image";
const WHOLE_MARGIN: &str = "whole image, margin";

/// What was found about the weights.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Weights {
    /// The largest |w_L + w_B − 1|, beyond noise.
    pub largest_deviation: f64,
    /// Exponents of p_L / p_B, distance, cosine at the light, number of lights, and 1 / density per area, in the odds of
    /// the weights of light samples; none if the weights are no such product.
    pub light_exponents: Option<[f64; 5]>,
    /// The same for the weights of BSDF samples, in the odds against them.
    pub bsdf_exponents: Option<[f64; 5]>,
    /// For paths with one vertex, with densities that are not extreme: log₁₀ (p_L / p_B), w_L and w_B, in the order of the first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub measured: Vec<[f32; 3]>,
}

/// What the weights of light samples, and those of BSDF samples, are called among a result's details if they are constant.
pub const CONSTANT_WEIGHTS: [&str; 2] = ["constant of light samples", "constant against BSDF samples"];

/// How noisy a hand-in is, compared with a technique.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct VarianceOf {
    /// The solution's technique that it is compared with.
    pub technique: Technique,
    /// The hand-in's variance of one sample, relative to that one's.
    pub ratio: f64,
}

/// How a check can end.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// What was looked for is right.
    Pass,
    /// It is wrong.
    Fail,
    /// It cannot be told: too noisy.
    Inconclusive,
    /// It was not looked at.
    LeftOut,
    /// The harness failed.
    Error,
}

/// Why a check ended as it did.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Reason {
    /// Nothing to complain about.
    None,
    /// The mean is wrong.
    Bias,
    /// The weights of multiple importance sampling are wrong.
    Weights,
    /// Too noisy.
    Noise,
    /// So noisy that a technique is missing.
    Efficiency,
    /// Random numbers that are shared or not those of the sampler.
    Randomness,
    /// More rays than the sheet allows.
    RayBudget,
    /// NaN, infinite or negative samples.
    Numerics,
    /// The hand-in took too long.
    Timeout,
    /// It panicked or its process died.
    Crash,
    /// It answered with what was not asked for.
    Violation,
    /// The harness failed.
    Harness,
}

impl CheckResult {
    /// True if it was run and did not pass.
    pub fn is_lacking(&self) -> bool {
        !matches!(self.verdict, Verdict::Pass | Verdict::LeftOut)
    }
}

/// A check that was not run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LeftOut {
    /// Which.
    pub check: String,
    /// In which scene.
    pub scene: String,
    /// Why it would mean nothing there.
    pub why: String,
}

/// A likely cause.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Diagnosis {
    /// Its name in the catalogue of causes, or `unknown`.
    pub mistake: String,
    /// What it is.
    pub title: String,
    /// How sure that is among all mistakes that are known, in [0, 1].
    pub confidence: f64,
    /// What was observed.
    pub evidence: String,
    /// What to think about.
    pub hint: String,
}

impl Diagnosis {
    /// The line that stands above evidence and hint, which are both empty if the cause is unknown.
    pub fn heading(&self) -> String {
        if self.mistake == UNKNOWN {
            self.title.clone()
        } else if self.confidence < 0.995 {
            format!("Likely cause ({:.0} % sure): {}", 100.0 * self.confidence, self.title)
        } else {
            format!("Likely cause: {}", self.title)
        }
    }
}

/// The name of the cause that is not known.
pub const UNKNOWN: &str = "unknown";

/// Samples that were no radiance, over all checks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Numerics {
    /// NaN or infinite.
    pub non_finite: u64,
    /// Finite but negative.
    pub negative: u64,
}

/// Where the time went, in seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Cost {
    /// Making the framework, the scenes and their references ready.
    pub framework: f64,
    /// Compiling the hand-in.
    pub build: f64,
    /// Running it.
    pub run: f64,
    /// Everything.
    pub total: f64,
}

/// How the hand-in was confined.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Sandbox {
    /// How well, in one word: what compiler and host have in common.
    pub level: Level,
    /// What is missing for the best level, in a sentence; empty if nothing is.
    pub missing: String,
    /// What held for rustc.
    pub compiler: Layers,
    /// What held for the program, as it found out itself before any code of the hand-in ran. For a hand-in that does
    /// not compile, what this machine has.
    pub host: Layers,
    /// What the hand-in names that the sandbox refuses. It costs no points by itself.
    pub findings: Vec<SourceFinding>,
}

impl Sandbox {
    /// What these layers come to.
    pub fn new(compiler: Layers, host: Layers, findings: Vec<SourceFinding>) -> Self {
        let layers = both(compiler, host);
        Self { level: Level::of(layers), missing: missing(layers).join(", "), compiler, host, findings }
    }
}

impl Report {
    /// The checks that a task lacks: first what is known to be wrong, of that what no points are without, then what is
    /// only not known to be right. Checks that were not run, since nothing depended on them any more, are not among
    /// them.
    pub fn lacking(&self, task: &str) -> Vec<&CheckResult> {
        let mut lacking: Vec<&CheckResult> =
            self.checks.iter().filter(|check| check.task == task && check.is_lacking()).collect();
        lacking.sort_by_key(|check| (check.verdict == Verdict::Inconclusive, !check.evidence));
        lacking
    }

    /// Reads what [`Self::save`] has written.
    ///
    /// # Errors
    /// If it is no report of this version.
    pub fn load(path: &Path) -> Result<Self> {
        let bytes = std::fs::read(path).map_err(|error| Error::file(path, error))?;
        let report: Self = serde_json::from_slice(&bytes)
            .map_err(|error| Error::file(path, format!("is no report of the grader: {error}")))?;
        if report.schema == SCHEMA {
            Ok(report)
        } else {
            Err(Error::file(path, format!("is a report of another version, not {SCHEMA}")))
        }
    }

    /// Writes the report as JSON.
    pub fn save(&self, path: &Path) -> Result<()> {
        Ok(arty::image::write_aside(path, |writer| serde_json::to_writer_pretty(writer, self))?)
    }
}
