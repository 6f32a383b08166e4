//! Testing means in a scene that depends on the seed: the solution renders what they should be.

use arty::scene::SceneDescription;
use verdict::error::Error;
use verdict::rubric::CheckSpec;

use super::context::settings_of;
use super::means::{Anomalies, Picture};
use super::{GradeContext, JobError};
use crate::statistics::sequential::{Decision, Judgement};
use arty::sampler::batch_seed;

/// Samples per pixel of the solution.
const SAMPLES: u32 = 2048;

/// Maximum number of looks. The last look takes as many samples as the solution. With one look fewer, one of 1,162
/// checks of a correct program was inconclusive, in an unusually noisy scene.
const LOOKS: usize = 4;

/// Tests the mean of a scene against a rendering of the solution. `scenes` is the number of scenes in the check.
///
/// # Errors
/// If the submission gives no valid answer, or the grader itself fails.
pub(super) fn judge(
    context: &GradeContext<'_>,
    spec: &CheckSpec,
    scene: &SceneDescription,
    seed: u64,
    scenes: u32,
) -> Result<(Judgement, Anomalies), JobError> {
    let no_solution = || Error::Harness(format!("{}: the solution to compare with is missing", spec.id()));
    let oracle = context.oracle.ok_or_else(no_solution)?;
    let attempt = |attempt: u64| {
        let seed = batch_seed(seed, attempt);
        let expected = oracle.expected(scene, settings_of(spec), SAMPLES, seed ^ 1, context.threads)?;
        let scene = [scene];
        let mut picture = Picture::of(context, spec, &scene, &expected);
        picture.screening_level /= f64::from(scenes);
        picture.looks = LOOKS.min(context.looks);
        picture.seed = seed;
        let mut anomalies = Anomalies::default();
        let judgement = picture.judge(context, &mut anomalies)?;
        Ok::<_, JobError>((judgement, anomalies))
    };
    let (first, anomalies) = attempt(1)?;
    if first.decision != Decision::Biased {
        return Ok((first, anomalies));
    }
    // The confirmation used the same rendering of the solution, so that the test is repeated with another one.
    let (mut second, anomalies) = attempt(2)?;
    second.samples += first.samples;
    Ok((second, anomalies))
}
