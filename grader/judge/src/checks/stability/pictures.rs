//! Extreme scenes with known answers, through the submission's code.

use arty::sampler::batch_seed;
use harness::host_process::HostProcess;
use host::protocol::{AnomalousSample, RenderJob};
use verdict::check::{Deviation, NumericalCause, Place, StabilityFinding};

use super::{Asked, Found, cause_of};
use crate::extreme::answers;
use crate::extreme::measure::{self, Effort, findings};
use harness::job::JobError;

/// Paths for each scene.
const EFFORT: Effort = Effort(1 << 13);

/// Pictures with more pixels than this say nothing about a submission: it is the framework that has to bear them.
const MOST_PIXELS: u32 = 64;

/// Longer paths cost time and say nothing new.
const MOST_BOUNCES: u32 = 400;

/// Pixels of a submission may be a thousandth off where those of the framework are right to a millionth.
const ALLOWED: f64 = 3e-3;

pub(super) fn find(asked: &Asked<'_>, process: &mut HostProcess) -> Found {
    let extremes = answers::load(asked.context.workspace)?;
    let technique = asked.settings.technique;
    let wanted = |answer: &answers::Answer| {
        answer.size[0] * answer.size[1] <= MOST_PIXELS && answer.max_bounces <= MOST_BOUNCES
    };
    let seen = findings(process, &extremes, technique, EFFORT, asked.seed, wanted)?;
    let mut found = Vec::new();
    let mut paths = 0;
    for mut picture in seen {
        paths += picture.measured.paths;
        picture.allowed = picture.allowed.max(ALLOWED + picture.measured.noise(picture.truth));
        if picture.is_right() {
            continue;
        }
        let extreme = extremes.iter().find(|extreme| extreme.answer.scene == picture.scene);
        let Some(extreme) = extreme else { continue };
        let suspect = match &picture.measured.first {
            Some(first) => Some(first.clone()),
            None => first_black(asked, process, extreme, &picture)?,
        };
        found.push(describe(asked, extreme, &picture, suspect));
    }
    Ok((found, paths))
}

/// The first sample that is black, of as many as are taken one by one: what most often makes a mean too small.
fn first_black(
    asked: &Asked<'_>,
    process: &mut HostProcess,
    extreme: &answers::Extreme,
    picture: &measure::Finding,
) -> Result<Option<AnomalousSample>, JobError> {
    if picture.measured.mean >= picture.truth {
        return Ok(None);
    }
    let scene = process.load(&extreme.description)?;
    let width = picture.size[0];
    let seeds: Vec<u64> = (0..64).map(|batch| batch_seed(asked.seed, batch)).collect();
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
    asked: &Asked<'_>,
    extreme: &answers::Extreme,
    picture: &measure::Finding,
    suspect: Option<AnomalousSample>,
) -> StabilityFinding {
    let measure::Finding { scene, truth, measured, settings, size, judged, .. } = picture;
    let deviation = if measured.is_clean() {
        let because = extreme.answer.because.clone();
        Deviation::Mean { found: measured.mean.into(), expected: (*truth).into(), because }
    } else {
        Deviation::Anomalies { non_finite: measured.non_finite, negative: measured.negative }
    };
    let likely_cause = match suspect.as_ref().map(|sample| sample.value[1]) {
        Some(value) if !(value.is_finite() && value >= 0.0) => cause_of(value),
        Some(_) => NumericalCause::HiddenNanOrOffset,
        None if measured.mean < *truth => NumericalCause::Limit,
        None => NumericalCause::LeakOrDoubleCount,
    };
    let replay = asked.replay(scene, *settings, *size);
    StabilityFinding {
        place: Place::ExtremeScene(scene.clone()),
        deviation,
        likely_cause,
        is_graded: *judged,
        first: suspect.as_ref().map(|sample| asked.anomaly(sample, replay.clone())),
        replay: suspect
            .is_none()
            .then(|| verdict::replay::ReplayTarget { seed: batch_seed(asked.seed, 0), ..replay }),
    }
}
