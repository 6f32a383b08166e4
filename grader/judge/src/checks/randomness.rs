//! **randomness**: are pixels and batches independent, and are renderings repeatable?
//!
//! Every standard error in this grader assumes that. A submission must draw its random numbers from the sampler that
//! it is given: then the same seed gives the same image, whatever was rendered before, another seed gives another
//! image, and no two pixels share random numbers.

use arty::sampler::batch_seed;
use host::protocol::RenderJob;
use verdict::check::{CheckKind, Evidence, RandomNumbers, Reason};
use verdict::rubric::CheckSpec;

use super::context::settings_of;
use super::{Check, CheckOutcome, GradeContext, JobError, Observation, WrongPlace};
use crate::reference::SIZE;
use crate::statistics::batches::Batches;
use crate::statistics::independence::{Dependence, dependence};

/// Number of batches, and samples per pixel of each batch.
const BATCHES: u64 = 64;
const SAMPLES: u64 = 4;

/// Significance level of the first test for shared random numbers, and of its confirmation with fresh seeds.
const LEVEL: f64 = 1e-4;

pub(super) struct Randomness;

impl Check for Randomness {
    fn kind(&self) -> CheckKind {
        CheckKind::Randomness
    }

    fn run(&self, context: &GradeContext<'_>, spec: &CheckSpec) -> Result<CheckOutcome, JobError> {
        let mut samples = 0;
        let numbers = find(context, spec, &mut samples)?;
        let reason = if numbers == RandomNumbers::Independent { Reason::None } else { Reason::Randomness };
        Ok(CheckOutcome::new(reason, Evidence::Randomness(numbers), samples))
    }

    fn observations(&self, evidence: &Evidence) -> Vec<Observation> {
        let Evidence::Randomness(numbers) = evidence else { return Vec::new() };
        let place = match numbers {
            RandomNumbers::Independent => return Vec::new(),
            RandomNumbers::SameImage(_) => WrongPlace::SameImage,
            RandomNumbers::NotRepeatable => WrongPlace::NotRepeatable,
            RandomNumbers::SharedByPixels { .. } => WrongPlace::SharedByPixels,
        };
        vec![Observation::wrong_at(place)]
    }
}

fn find(context: &GradeContext<'_>, spec: &CheckSpec, samples: &mut u64) -> Result<RandomNumbers, JobError> {
    let seeds: Vec<u64> = (0..BATCHES).map(|batch| batch_seed(context.seed_of(spec), batch)).collect();
    let images = render(context, spec, &seeds, samples)?;
    if let Some((a, b)) = same_images(&images) {
        return Ok(RandomNumbers::SameImage([a as u32, b as u32]));
    }
    // In a new process and in reverse order, so that no state of earlier renderings remains.
    let reversed: Vec<u64> = seeds.iter().rev().copied().collect();
    let again = render(context, spec, &reversed, samples)?;
    if images.iter().ne(again.iter().rev()) {
        return Ok(RandomNumbers::NotRepeatable);
    }
    if found(&images).p_value >= LEVEL {
        return Ok(RandomNumbers::Independent);
    }
    let fresh: Vec<u64> = seeds.iter().map(|&seed| batch_seed(seed, 1)).collect();
    let Dependence { p_value, excess, pixels } = found(&render(context, spec, &fresh, samples)?);
    Ok(if p_value < LEVEL {
        RandomNumbers::SharedByPixels { excess, pixels }
    } else {
        RandomNumbers::Independent
    })
}

fn render(
    context: &GradeContext<'_>,
    spec: &CheckSpec,
    seeds: &[u64],
    samples: &mut u64,
) -> Result<Vec<Vec<[f32; 3]>>, JobError> {
    let mut process = context.start()?;
    let scene = process.load(&context.scene(spec).description)?;
    *samples += seeds.len() as u64 * SAMPLES * u64::from(SIZE.0 * SIZE.1);
    let job = RenderJob::new(scene, settings_of(spec), [SIZE.0, SIZE.1], seeds.to_vec(), SAMPLES);
    Ok(process.render(&job)?.batches)
}

/// Indices of two images that are equal bit by bit. Black images are ignored: they may well be equal.
fn same_images(images: &[Vec<[f32; 3]>]) -> Option<(usize, usize)> {
    let black = |image: &[[f32; 3]]| image.iter().flatten().all(|&value| value == 0.0);
    let mut seen = std::collections::BTreeMap::new();
    for (index, image) in images.iter().enumerate().filter(|(_, image)| !black(image)) {
        let bits: Vec<u32> = image.iter().flatten().map(|value| value.to_bits()).collect();
        if let Some(first) = seen.insert(bits, index) {
            return Some((first, index));
        }
    }
    None
}

fn found(images: &[Vec<[f32; 3]>]) -> Dependence {
    let mut batches = Batches::default();
    batches.extend(images, SAMPLES);
    dependence(&batches, SIZE.0)
}
