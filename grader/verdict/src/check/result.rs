//! The result of a check.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{CheckId, Evidence, Fault, MeanTest, Numerics, Visibility};

/// Result of one check of one submission.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CheckResult {
    /// Identity of the check.
    pub id: CheckId,
    /// Number of the task that it belongs to.
    pub task: String,
    /// True if it must pass for any points in its task; slight errors are tolerated.
    pub required: bool,
    /// Who may see the check.
    pub visibility: Visibility,
    /// The verdict.
    pub verdict: Verdict,
    /// Code of the reason for the verdict.
    pub reason: Reason,
    /// What went wrong if the submission gave no valid answer.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fault: Option<Fault>,
    /// Measurements; `None` if the check was not run or got no valid answer.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub evidence: Option<Evidence>,
    /// Samples that are not radiance (NaN, infinite or negative).
    #[serde(default, skip_serializing_if = "Numerics::is_clean")]
    pub numerics: Numerics,
    /// True if it was run with few samples, because a required check has already cost the points.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub short_look: bool,
    /// Number of paths traced.
    pub samples: u64,
    /// Wall time in seconds.
    pub seconds: f64,
}

/// Verdict of a check.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// The submission is right.
    Pass,
    /// The submission is wrong.
    Fail,
    /// Too noisy to decide.
    Inconclusive,
    /// The check was not run, since its result cannot affect the points.
    Skipped {
        /// The reason.
        why: SkipReason,
    },
    /// The check could not be run and earns no points.
    NotRun {
        /// The reason.
        why: NotRun,
    },
}

/// Why a check was skipped.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SkipReason {
    /// This required check has already cost the points of the task; `None` if students may not see that check.
    PointsLostTo(Option<CheckId>),
}

/// Why a check could not be run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum NotRun {
    /// Earlier checks exceeded their time limits too often.
    OutOfTime,
}

/// Reason for a verdict.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Reason {
    /// The check passed.
    None,
    /// A mean is wrong.
    Bias,
    /// MIS weights are wrong.
    Weights,
    /// Too noisy to decide.
    Noise,
    /// As noisy as if a technique were missing.
    Efficiency,
    /// Random numbers are shared between pixels or seeds, or are not those of the sampler.
    Randomness,
    /// Paths trace more rays than the sheet allows.
    RayBudget,
    /// NaN, infinite or negative samples.
    Numerics,
    /// The submission exceeded its time limit.
    Timeout,
    /// The submission panicked or its process died.
    Crash,
    /// The answer violated the protocol.
    Violation,
}

impl CheckResult {
    /// True if the check costs its task points: it failed, is inconclusive or could not be run.
    pub fn costs_points(&self) -> bool {
        !matches!(self.verdict, Verdict::Pass | Verdict::Skipped { .. })
    }

    /// True if it was run, whatever the verdict.
    pub fn was_run(&self) -> bool {
        !matches!(self.verdict, Verdict::Skipped { .. } | Verdict::NotRun { .. })
    }

    /// True if it failed by an error of at most 2 % in a mean, in the shares of lights or in the sum of the weights.
    /// Whether such an error is detected depends on noise, so that points may not depend on how many checks detect it.
    pub fn is_slightly_wrong(&self) -> bool {
        let is_wrong = self.verdict == Verdict::Fail && matches!(self.reason, Reason::Bias | Reason::Weights);
        is_wrong
            && match &self.evidence {
                Some(Evidence::MisWeights(test)) => test.is_slightly_wrong(),
                Some(Evidence::Facts(facts)) => facts.are_slight(),
                Some(Evidence::LightPick(shares)) => shares.are_slightly_wrong(),
                Some(evidence) => evidence.mean_test().is_some_and(MeanTest::is_slightly_wrong),
                None => false,
            }
    }

    /// The test of the picture whose mean decided; `None` if the check does not test means.
    pub fn mean_test(&self) -> Option<&MeanTest> {
        self.evidence.as_ref().and_then(Evidence::mean_test)
    }
}
