//! **efficiency**: is it really next event estimation, really multiple importance sampling?
//!
//! Means cannot tell: BSDF sampling is right wherever light has an area. Noise can. In scenes where a technique is at
//! least 20 times less noisy than those that it is made of, its variance is compared with what the reference
//! says of each of them, at equal numbers of samples.

use arty::integrator::Technique;
use host::protocol::{RenderJob, Switches};

use super::{Bench, JudgedScene, Stop};
use crate::reference::SIZE;
use crate::statistics::batches::Batches;
use crate::statistics::bias::Expected;
use crate::statistics::variance::VarianceRatio;
use arty::integrator::Settings;
use arty::sampler::batch_seed;
use verdict::error::Error;
use verdict::report::{CheckResult, Reason, VarianceOf, Verdict};
use verdict::rubric::{CheckSpec, rivals};

/// How much noisier the other technique has to be for a scene to tell.
const TELLING: f64 = 20.0;

/// How much noisier than the solution a hand-in has to be, at least, to lack a technique.
const LACKING: f64 = 3.0;

/// The level at which it has to be that.
const LEVEL: f64 = 1e-5;

/// Independent renderings, and samples of each pixel in each.
const BATCHES: u64 = 64;
const SAMPLES: u64 = 8;

pub(super) fn run(bench: &Bench<'_>, spec: &CheckSpec, result: &mut CheckResult) -> Result<(), Stop> {
    let judged = bench.scene(spec);
    let moments = |technique| moments(judged, spec, technique);
    let own = moments(spec.technique)?;
    if let Some(why) = why_it_does_not_tell(judged, spec) {
        return Err(Error::Input(format!("{}: {why}", spec.id())).into());
    }
    let seed = bench.seed_of(spec);
    let mut process = bench.start()?;
    let scene = process.load(&judged.description)??;
    let rendered = process.render(&RenderJob {
        scene,
        settings: Settings { technique: spec.technique, max_bounces: spec.max_bounces },
        width: SIZE.0,
        height: SIZE.1,
        seeds: (0..BATCHES).map(|batch| batch_seed(seed, batch)).collect(),
        first_sample: 0,
        samples: SAMPLES,
        switches: Switches::default(),
    })??;
    let mut batches = Batches::default();
    batches.extend(&rendered.batches, SAMPLES);
    result.samples = batches.samples_per_pixel() * u64::from(SIZE.0 * SIZE.1);

    let ratio_to = |expected: &Expected| VarianceRatio::new(&batches, &own.mean, &expected.deviation);
    let Some(ratio) = ratio_to(&own) else {
        result.verdict = Verdict::Fail;
        result.reason = Reason::Efficiency;
        result.explanation = "the image has no noise at all: it shows nothing".to_owned();
        return Ok(());
    };
    result.variance_ratios.push(VarianceOf { technique: spec.technique, ratio: ratio.ratio() });
    let mut nearest = (spec.technique, ratio.log.abs());
    for &technique in rivals(spec.technique) {
        let rival = moments(technique)?;
        let Some(to_rival) = ratio_to(&rival) else { continue };
        result.variance_ratios.push(VarianceOf { technique, ratio: to_rival.ratio() });
        // A technique that is hardly noisier here does not tell.
        if total(&rival) / total(&own) >= TELLING && to_rival.log.abs() < nearest.1 {
            nearest = (technique, to_rival.log.abs());
        }
    }
    let factor = ratio.ratio();
    // Noisier than the solution, and just as noisy as what it is made of: anything else is a style of its own.
    let lacking = ratio.at_least(LEVEL) > LACKING && nearest.0 != spec.technique && nearest.1 < LACKING.ln();
    (result.verdict, result.reason, result.explanation) = if lacking {
        let what = match nearest.0 {
            Technique::Bsdf => "as noisy as BSDF sampling: light samples have no part in it",
            Technique::Nee => "as noisy as next event estimation: lights that are hit have no part in it",
            Technique::Mis => "as noisy as multiple importance sampling",
        };
        (
            Verdict::Fail,
            Reason::Efficiency,
            format!("{factor:.0} times as noisy as the solution's, and {what}"),
        )
    } else {
        let name = spec.technique;
        (Verdict::Pass, Reason::None, format!("{factor:.2} times the variance of the solution's {name}"))
    };
    if result.verdict == Verdict::Pass && ratio.at_least(LEVEL) > 1.5 {
        result
            .remarks
            .push(format!("right, but {factor:.1} times as noisy as the solution with equally many samples"));
    }
    Ok(())
}

/// Why a technique could not be told from others by its noise there; `None` if it can be told from one at least.
pub fn why_it_does_not_tell(judged: &JudgedScene, spec: &CheckSpec) -> Option<String> {
    let unknown = || Some("its reference does not say how noisy the other techniques are".to_owned());
    let Ok(own) = moments(judged, spec, spec.technique) else { return unknown() };
    let mut most = 0.0f64;
    for &technique in rivals(spec.technique) {
        let Ok(rival) = moments(judged, spec, technique) else { return unknown() };
        most = most.max(total(&rival) / total(&own));
    }
    (most < TELLING).then(|| {
        format!(
            "the other techniques are at most {most:.1} times as noisy there; {TELLING:.0} times are needed to tell"
        )
    })
}

/// The variance of one sample over the whole image, relative to m² + m̄².
fn total(expected: &Expected) -> f64 {
    let count = 3.0 * expected.mean.len().max(1) as f64;
    let image_mean = expected.mean.iter().flatten().sum::<f64>() / count;
    let pairs = expected.deviation.iter().flatten().zip(expected.mean.iter().flatten());
    pairs.map(|(deviation, mean)| deviation.powi(2) / (mean.powi(2) + image_mean.powi(2))).sum()
}

fn moments(judged: &JudgedScene, spec: &CheckSpec, technique: Technique) -> Result<Expected, Error> {
    super::mean_bias::expected(&CheckSpec { technique, ..spec.clone() }, &judged.reference)
}
