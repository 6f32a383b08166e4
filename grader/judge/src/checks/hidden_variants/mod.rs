//! **hidden-variants**: scenes that nobody has seen before, drawn anew for each seed of a grade.
//!
//! There is no reference of them: the solution renders them at the same time, by the same protocol. Whatever fits the
//! known scenes only shows here.

mod draw;

use arty::integrator::Settings;
use arty::sampler::{Sampler, batch_seed};

use super::means::{self, Numerics, Picture};
use super::{Bench, Stop};
use crate::statistics::sequential::Decision;
use verdict::error::Error;
use verdict::report::{CheckResult, Verdict};
use verdict::rubric::CheckSpec;

/// Scenes in each check.
const SCENES: u64 = 2;

/// Samples of each pixel by the solution.
const SAMPLES: u32 = 2048;

/// Looks at most: the last takes as many samples as the solution. With one look fewer, one of 1,162 of these checks left a
/// correct program undecided, in a scene that is noisier than most.
const LOOKS: usize = 4;

pub(super) fn run(bench: &Bench<'_>, spec: &CheckSpec, result: &mut CheckResult) -> Result<(), Stop> {
    let oracle = bench
        .oracle
        .ok_or_else(|| Error::Harness(format!("{}: there is no solution to compare with", spec.id())))?;
    let settings = Settings { technique: spec.technique, max_bounces: spec.max_bounces };
    let mut samples = 0;
    for number in 0..SCENES {
        let seed = batch_seed(bench.seed_of(spec), number);
        let scene = draw::scene(&mut Sampler::new(seed, (0, 0), 0));
        let judge = |attempt: u64| {
            let seed = batch_seed(seed, attempt);
            let expected = oracle.expected(&scene, settings, SAMPLES, seed ^ 1, bench.threads)?;
            let scenes = [&scene];
            let mut picture = Picture::of(bench, spec, &scenes, &expected);
            picture.screening_level /= SCENES as f64;
            picture.looks = LOOKS.min(bench.looks);
            picture.seed = seed;
            let mut numerics = Numerics::default();
            let judgement = picture.judge(bench, &mut numerics)?;
            Ok::<_, Stop>((judgement, numerics))
        };
        let (mut judgement, mut numerics) = judge(1)?;
        if judgement.decision == Decision::Biased {
            // The confirmation that was had rests on the same rendering of the solution: once more with another.
            samples += judgement.samples;
            (judgement, numerics) = judge(2)?;
        }
        samples += judgement.samples;
        means::describe(result, &judgement, spec.tolerance);
        numerics.enter(result, |_| None);
        if result.verdict != Verdict::Pass {
            result.explanation = format!("in scene {} of {SCENES}, {}", number + 1, result.explanation);
            break;
        }
    }
    result.samples = samples;
    Ok(())
}
