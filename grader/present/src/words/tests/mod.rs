//! The sentences, pinned: one table a kind of check.

mod means;
mod reports;
mod stability;
mod techniques;
mod weights;

use arty::integrator::Technique;

use super::*;
use ::verdict::check::*;
use ::verdict::number::Float;
use ::verdict::replay::ReplayTarget;
use ::verdict::report::{Cause, Diagnosis, Points, Report, SeenIn, TaskResult, TaskState};
use ::verdict::rubric::EmissionOnHit;
use ::verdict::sample::{furnace_test, id, mean_test, report};
use ::verdict::submission::{BuildFailure, IntakeFinding};

/// A check with this verdict and evidence.
fn check(verdict: Verdict, evidence: Evidence) -> CheckResult {
    let sample = report("x").checks[0].clone();
    CheckResult { id: id(evidence.kind(), "box"), verdict, evidence: Some(evidence), ..sample }
}

fn fails(evidence: Evidence) -> String {
    explanation(&check(Verdict::Fail, evidence))
}

fn passes(evidence: Evidence) -> String {
    explanation(&check(Verdict::Pass, evidence))
}

fn target() -> ReplayTarget {
    ReplayTarget {
        scene: "box".to_owned(),
        scale: 1.0,
        emission: 1.0,
        technique: Technique::Nee,
        max_bounces: 8,
        emission_on_hit: EmissionOnHit::On,
        size: [32, 24],
        seed: 7,
        pixel: [3, 4],
        sample: 5,
    }
}

fn anomaly() -> Anomaly {
    Anomaly { pixel: [3, 4], sample: 5, value: [f64::NAN, 0.5, 0.0].map(Float), replay: Some(target()) }
}
