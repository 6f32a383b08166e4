//! **hidden-variants**: means in randomly generated scenes, new for each seed of a grade.
//!
//! They have no reference: the solution renders them during the grade, by the same protocol. A submission that is
//! tuned to the known scenes fails here.

mod draw;

use arty::sampler::{Sampler, batch_seed};
use verdict::check::{CheckKind, Evidence, VariantTest, Verdict};
use verdict::rubric::CheckSpec;

use super::{Check, CheckOutcome, GradeContext, JobError, Observation, against_oracle, means};

/// Number of scenes per check.
const SCENES: u32 = 2;

pub(super) struct HiddenVariants;

impl Check for HiddenVariants {
    fn kind(&self) -> CheckKind {
        CheckKind::HiddenVariants
    }

    fn run(&self, context: &GradeContext<'_>, spec: &CheckSpec) -> Result<CheckOutcome, JobError> {
        let mut samples = 0;
        let mut last = None;
        for number in 0..SCENES {
            let outcome = judge(context, spec, number)?;
            samples += outcome.samples;
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
fn judge(context: &GradeContext<'_>, spec: &CheckSpec, number: u32) -> Result<CheckOutcome, JobError> {
    let seed = batch_seed(context.seed_of(spec), u64::from(number));
    let scene = draw::scene(&mut Sampler::new(seed, (0, 0), 0));
    let (judgement, anomalies) = against_oracle::judge(context, spec, &scene, seed, SCENES)?;
    let test = means::mean_test(&judgement, spec.tolerance);
    let evidence = VariantTest { scene: number + 1, scenes: SCENES, test };
    let outcome = means::conclude(&judgement, Evidence::HiddenVariants(evidence), judgement.samples);
    Ok(outcome.with(anomalies.numerics(None)))
}
