//! Extreme scenes with known answers, through the hand-in's code.

use arty::integrator::Settings;
use host::protocol::{AnomalousSample, RenderJob, Switches};

use super::{Asked, Finding, Found};
use crate::extreme::answers;
use crate::extreme::measure::{self, Effort, findings};
use crate::replay::Place;
use harness::host_process::{Fault, HostProcess};
use verdict::error::Result;

/// Paths for each scene.
const EFFORT: Effort = Effort(1 << 13);

/// Pictures with more pixels than this say nothing about a hand-in: it is the framework that has to bear them.
const MOST_PIXELS: u32 = 64;

/// Longer paths cost time and say nothing new.
const MOST_BOUNCES: u32 = 400;

/// Pixels of a hand-in may be a thousandth off where those of the framework are right to a millionth.
const ALLOWED: f64 = 3e-3;

pub(super) fn find(asked: &Asked<'_>, process: &mut HostProcess) -> Found {
    let extremes = answers::load(asked.bench.workspace)?;
    let technique = asked.settings.technique;
    let wanted = |answer: &answers::Answer| {
        answer.size[0] * answer.size[1] <= MOST_PIXELS && answer.max_bounces <= MOST_BOUNCES
    };
    let seen = match findings(process, &extremes, technique, EFFORT, asked.seed, wanted)? {
        Ok(seen) => seen,
        Err(fault) => return Ok(Err(fault)),
    };
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
            Some(first) => Ok(Some(first.clone())),
            None => first_black(asked, process, extreme, &picture)?,
        };
        match suspect {
            Ok(suspect) => found.push(describe(asked, extreme, &picture, suspect)),
            Err(fault) => return Ok(Err(fault)),
        }
    }
    Ok(Ok((found, paths)))
}

/// The first sample that is black, of as many as are taken one by one: what most often makes a mean too small.
fn first_black(
    asked: &Asked<'_>,
    process: &mut HostProcess,
    extreme: &answers::Extreme,
    picture: &measure::Finding,
) -> Result<std::result::Result<Option<AnomalousSample>, Fault>> {
    if picture.measured.mean >= picture.truth {
        return Ok(Ok(None));
    }
    let scene = match process.load(&extreme.description)? {
        Ok(scene) => scene,
        Err(fault) => return Ok(Err(fault)),
    };
    let [width, height] = picture.size;
    let seeds: Vec<u64> = (0..64).map(|batch| arty::sampler::batch_seed(asked.seed, batch)).collect();
    let job = RenderJob {
        scene,
        settings: picture.settings,
        width,
        height,
        seeds: seeds.clone(),
        first_sample: 0,
        samples: 1,
        switches: Switches::default(),
    };
    Ok(process.render(&job)?.map(|rendered| {
        let all =
            rendered.batches.iter().zip(seeds).flat_map(|(batch, seed)| {
                batch.iter().zip(0..).map(move |(value, pixel)| (seed, pixel, *value))
            });
        all.into_iter().find(|(_, _, value)| value[1] == 0.0).map(|(seed, pixel, value)| AnomalousSample {
            seed,
            x: pixel % width,
            y: pixel / width,
            sample: 0,
            value,
        })
    }))
}

fn describe(
    asked: &Asked<'_>,
    extreme: &answers::Extreme,
    picture: &measure::Finding,
    suspect: Option<AnomalousSample>,
) -> Finding {
    let measure::Finding { scene, truth, measured, settings, size, judged, .. } = picture;
    let what = if measured.is_clean() {
        format!("the mean is {:.4e} instead of {truth:.4e} ({})", measured.mean, extreme.answer.because)
    } else {
        format!("{} samples are NaN or infinite and {} negative", measured.non_finite, measured.negative)
    };
    let (place, cause) = match &suspect {
        Some(sample) => {
            let value = sample.value[1];
            let cause = if value.is_nan() {
                "0/0, ∞/∞ or the root or arc cosine of what is out of its range"
            } else if value.is_infinite() {
                "a division by 0, or an overflow"
            } else if value < 0.0 {
                "a cosine whose sign was not looked at"
            } else {
                "a value that is no number, hidden as 0, or a ray that starts or ends too near"
            };
            (
                format!(
                    "; the first: pixel ({}, {}), sample {}, value {:?}",
                    sample.x, sample.y, sample.sample, sample.value
                ),
                cause,
            )
        }
        None if measured.mean < *truth => (String::new(), "a limit on radiance, densities or distances"),
        None => (String::new(), "a ray that passes what it should not, or light that counts twice"),
    };
    let Settings { technique, max_bounces } = *settings;
    let path = Place {
        scene: scene.clone(),
        description: extreme.description.clone(),
        scale: 1.0,
        emission: 1.0,
        technique,
        max_bounces,
        size: *size,
        seed: arty::sampler::batch_seed(asked.seed, 0),
        pixel: [0, 0],
        sample: 0,
        switches: Switches::default(),
    };
    let path = suspect.as_ref().map_or(path.clone(), |sample| path.of(sample));
    Finding {
        text: format!(
            "in {scene}: {what}{place}; likely cause: {cause}; see it again with `{}`",
            path.command(&asked.bench.path)
        ),
        judged: *judged,
        anomalies: [measured.non_finite, measured.negative],
    }
}
