//! The outcome of a check.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{CheckId, Evidence, Fault, MeanTest, Numerics, Visibility};

/// What one check of one submission has come to.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CheckResult {
    /// Identity of the check.
    pub id: CheckId,
    /// The task that it decides.
    pub task: String,
    /// True if it must pass for any points in its task.
    pub required: bool,
    /// Who may see it.
    pub visibility: Visibility,
    /// How it ended.
    pub verdict: Verdict,
    /// Why, as a code.
    pub reason: Reason,
    /// What the submission did instead of answering, if it did.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fault: Option<Fault>,
    /// What was measured; none where the check was not run, or got no answer.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub evidence: Option<Evidence>,
    /// Samples that are not radiance.
    #[serde(default, skip_serializing_if = "Numerics::is_clean")]
    pub numerics: Numerics,
    /// True if it was given only a short look, because the points are lost to another check.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub short_look: bool,
    /// Paths traced.
    pub samples: u64,
    /// Wall time in seconds.
    pub seconds: f64,
}

/// How a check can end.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// It is right.
    Pass,
    /// It is wrong.
    Fail,
    /// Neither can be told.
    Inconclusive,
    /// Its result could change nothing, so it was not run.
    Skipped {
        /// Why.
        why: SkipReason,
    },
    /// It could not be run, and earns nothing.
    NotRun {
        /// Why.
        why: NotRun,
    },
}

/// Why a check was skipped.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SkipReason {
    /// The points of its task are lost to this check; none where students do not see it.
    PointsLostTo(Option<CheckId>),
}

/// Why a check could not be run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum NotRun {
    /// The submission used up its time in earlier checks.
    OutOfTime,
}

/// Why a check ended as it did.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Reason {
    /// Nothing is wrong.
    None,
    /// The mean is wrong.
    Bias,
    /// MIS weights are wrong.
    Weights,
    /// Too noisy to tell.
    Noise,
    /// So noisy that a technique is missing.
    Efficiency,
    /// Random numbers are shared, or not the sampler's.
    Randomness,
    /// More rays than the sheet allows.
    RayBudget,
    /// NaN, infinite or negative samples.
    Numerics,
    /// The submission took too long.
    Timeout,
    /// It panicked or its process ended.
    Crash,
    /// Its answer was not what was asked for.
    Violation,
}

impl CheckResult {
    /// True if its task lacks points for it.
    pub fn is_lacking(&self) -> bool {
        !matches!(self.verdict, Verdict::Pass | Verdict::Skipped { .. })
    }

    /// True if it was run, to whatever end.
    pub fn was_run(&self) -> bool {
        !matches!(self.verdict, Verdict::Skipped { .. } | Verdict::NotRun { .. })
    }

    /// The picture whose mean decided, where one did.
    pub fn mean_test(&self) -> Option<&MeanTest> {
        self.evidence.as_ref().and_then(Evidence::mean_test)
    }
}
