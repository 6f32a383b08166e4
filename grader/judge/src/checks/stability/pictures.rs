//! Extreme scenes with known means, rendered by the submission.

use arty::sampler::batch_seed;
use harness::host_process::HostProcess;
use host::protocol::{AnomalousSample, RenderJob};
use verdict::check::{Deviation, NumericalCause, Place, StabilityFinding};

use super::{PartResult, StabilityContext, anomaly, cause_of, is_radiance};
use crate::extreme::answers;
use crate::extreme::measure::{self, MinPaths, measure_all};
use harness::job::JobError;

/// Minimum number of paths per scene.
const MIN_PATHS: MinPaths = MinPaths(1 << 13);

/// Maximum number of pixels: larger pictures test the framework, not the submission.
const MAX_PIXELS: u32 = 64;

/// Maximum number of bounces: longer paths take time without testing anything new.
const MAX_BOUNCES: u32 = 400;

/// Relative error that is tolerated in a submission, where the framework itself is far more accurate.
const TOLERANCE: f64 = 3e-3;

pub(super) fn find(stability: &StabilityContext<'_>, process: &mut HostProcess) -> PartResult {
    let extremes = answers::load(stability.context.workspace)?;
    let technique = stability.settings.technique;
    let wanted = |answer: &answers::Answer| {
        answer.size[0] * answer.size[1] <= MAX_PIXELS && answer.max_bounces <= MAX_BOUNCES
    };
    let seen = measure_all(process, &extremes, technique, MIN_PATHS, stability.seed, wanted)?;
    let mut found = Vec::new();
    let mut paths = 0;
    for mut picture in seen {
        paths += picture.measured.paths;
        picture.allowed = picture.allowed.max(TOLERANCE + picture.measured.noise(picture.truth));
        if picture.is_right() {
            continue;
        }
        let extreme = extremes.iter().find(|extreme| extreme.answer.scene == picture.scene);
        let Some(extreme) = extreme else { continue };
        let suspect = match &picture.measured.first {
            Some(first) => Some(first.clone()),
            None if picture.measured.panic.is_some() => None,
            None => first_black(stability, process, extreme, &picture)?,
        };
        found.push(describe(stability, extreme, &picture, suspect));
    }
    Ok((found, paths))
}

/// The first black sample of 64 renderings with one sample per pixel, since black samples are the most frequent cause
/// of a mean that is too small. `None` if the mean is not too small or no sample is black.
fn first_black(
    stability: &StabilityContext<'_>,
    process: &mut HostProcess,
    extreme: &answers::ExtremeScene,
    picture: &measure::ExtremeSceneResult,
) -> Result<Option<AnomalousSample>, JobError> {
    if picture.measured.mean >= picture.truth {
        return Ok(None);
    }
    let scene = process.load(&extreme.description)?;
    let width = picture.size[0];
    let seeds: Vec<u64> = (0..64).map(|batch| batch_seed(stability.seed, batch)).collect();
    let job = RenderJob::new(scene, picture.settings, picture.size, seeds.clone(), 1);
    let rendered = process.render(&job)?;
    let mut all = rendered
        .batches
        .iter()
        .zip(seeds)
        .flat_map(|(batch, seed)| batch.iter().zip(0..).map(move |(value, pixel)| (seed, pixel, *value)));
    let black = all.find(|(_, _, value)| value[1] == 0.0);
    Ok(black.map(|(seed, pixel, value)| AnomalousSample {
        seed,
        x: pixel % width,
        y: pixel / width,
        sample: 0,
        value,
    }))
}

fn describe(
    stability: &StabilityContext<'_>,
    extreme: &answers::ExtremeScene,
    picture: &measure::ExtremeSceneResult,
    suspect: Option<AnomalousSample>,
) -> StabilityFinding {
    let measure::ExtremeSceneResult { scene, truth, measured, settings, size, is_graded, .. } = picture;
    let deviation = if let Some(message) = &measured.panic {
        Deviation::Panic { message: message.clone() }
    } else if measured.is_clean() {
        let because = extreme.answer.because.clone();
        Deviation::Mean { found: measured.mean.into(), expected: (*truth).into(), because }
    } else {
        Deviation::Anomalies { non_finite: measured.non_finite, negative: measured.negative }
    };
    let likely_cause = match suspect.as_ref().map(|sample| sample.value[1]) {
        None if measured.panic.is_some() => {
            let has_lights = arty::scene::Scene::new(&extreme.description).features().has_lights();
            if has_lights { NumericalCause::Panic } else { NumericalCause::NoLights }
        }
        Some(value) if !is_radiance(value) => cause_of(value),
        Some(_) => NumericalCause::HiddenNanOrOffset,
        None if measured.mean < *truth => NumericalCause::Limit,
        None => NumericalCause::LeakOrDoubleCount,
    };
    let replay = stability.replay(scene, *settings, *size);
    StabilityFinding {
        place: Place::ExtremeScene(scene.clone()),
        deviation,
        likely_cause,
        is_graded: *is_graded,
        first: suspect.as_ref().map(|sample| anomaly(sample, Some(replay.clone()))),
        replay: suspect
            .is_none()
            .then(|| verdict::replay::ReplayTarget { seed: batch_seed(stability.seed, 0), ..replay }),
    }
}
