//! **hidden-variants**: means in randomly generated scenes, new for each seed of a grade.
//!
//! They have no reference: the solution renders them during the grade, by the same protocol. A submission that is
//! tuned to the known scenes fails here.

mod draw;

use arty::sampler::{Sampler, batch_seed};
use verdict::check::{CheckKind, Evidence, VariantTest, Verdict};
use verdict::error::Error;
use verdict::rubric::CheckSpec;

use super::context::settings_of;
use super::means::{self, Anomalies, Picture};
use super::{Check, CheckOutcome, GradeContext, JobError, Observation};
use crate::statistics::sequential::Decision;

/// Number of scenes per check.
const SCENES: u64 = 2;

/// Samples per pixel of the solution.
const SAMPLES: u32 = 2048;

/// Maximum number of looks. The last look takes as many samples as the solution. With one look fewer, one of 1,162 of
/// these checks of a correct program was inconclusive, in an unusually noisy scene.
const LOOKS: usize = 4;

pub(super) struct HiddenVariants;

impl Check for HiddenVariants {
    fn kind(&self) -> CheckKind {
        CheckKind::HiddenVariants
    }

    fn run(&self, context: &GradeContext<'_>, spec: &CheckSpec) -> Result<CheckOutcome, JobError> {
        let mut samples = 0;
        let mut last = None;
        for number in 0..SCENES {
            let outcome = judge(context, spec, number, &mut samples)?;
            let passes = outcome.verdict == Verdict::Pass;
            last = Some(outcome);
            if !passes {
                break;
            }
        }
        let outcome = last.expect("there are several scenes");
        Ok(CheckOutcome { samples, ..outcome })
    }

    fn observations(&self, _: &Evidence) -> Vec<Observation> {
        // Each seed has other scenes, which cannot be compared.
        Vec::new()
    }
}

/// Tests the mean of one of the scenes.
fn judge(
    context: &GradeContext<'_>,
    spec: &CheckSpec,
    number: u64,
    samples: &mut u64,
) -> Result<CheckOutcome, JobError> {
    let no_solution = || Error::Harness(format!("{}: the solution to compare with is missing", spec.id()));
    let oracle = context.oracle.ok_or_else(no_solution)?;
    let seed = batch_seed(context.seed_of(spec), number);
    let scene = draw::scene(&mut Sampler::new(seed, (0, 0), 0));
    let mut attempt = |attempt: u64| {
        let seed = batch_seed(seed, attempt);
        let expected = oracle.expected(&scene, settings_of(spec), SAMPLES, seed ^ 1, context.threads)?;
        let scenes = [&scene];
        let mut picture = Picture::of(context, spec, &scenes, &expected);
        picture.screening_level /= SCENES as f64;
        picture.looks = LOOKS.min(context.looks);
        picture.seed = seed;
        let mut anomalies = Anomalies::default();
        let judgement = picture.judge(context, &mut anomalies)?;
        *samples += judgement.samples;
        Ok::<_, JobError>((judgement, anomalies))
    };
    let (mut judgement, mut anomalies) = attempt(1)?;
    if judgement.decision == Decision::Biased {
        // The confirmation used the same rendering of the solution, so that the test is repeated with another one.
        (judgement, anomalies) = attempt(2)?;
    }
    let test = means::mean_test(&judgement, spec.tolerance);
    let evidence = VariantTest { scene: number as u32 + 1, scenes: SCENES as u32, test };
    let outcome = means::conclude(&judgement, Evidence::HiddenVariants(evidence), 0);
    Ok(outcome.with(anomalies.numerics(None)))
}
