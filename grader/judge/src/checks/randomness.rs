//! **randomness**: is each pixel and each batch a thing of its own?
//!
//! Every standard error in this grader rests on that. A hand-in has to draw its random numbers from the sampler that
//! it is given: then the same seed gives the same image, whatever was rendered before; another seed gives another; and
//! no two pixels share anything.

use arty::integrator::Settings;
use arty::sampler::batch_seed;
use host::protocol::{RenderJob, Switches};

use super::{Bench, Stop};
use crate::reference::SIZE;
use crate::statistics::batches::Batches;
use crate::statistics::independence::{Dependence, dependence};
use verdict::report::{CheckResult, Reason, Verdict};
use verdict::rubric::CheckSpec;

/// Independent renderings, and samples of each pixel in each.
const BATCHES: u64 = 64;
const SAMPLES: u64 = 4;

/// The level of the first look at the pixels, and of the one that confirms it with fresh seeds.
const LEVEL: f64 = 1e-4;

pub(super) fn run(bench: &Bench<'_>, spec: &CheckSpec, result: &mut CheckResult) -> Result<(), Stop> {
    let complaint = complaint(bench, spec, result)?;
    (result.verdict, result.reason, result.explanation) = match complaint {
        Some(complaint) => (Verdict::Fail, Reason::Randomness, complaint),
        None => (
            Verdict::Pass,
            Reason::None,
            "pixels, batches and seeds are independent and repeatable".to_owned(),
        ),
    };
    Ok(())
}

fn complaint(bench: &Bench<'_>, spec: &CheckSpec, result: &mut CheckResult) -> Result<Option<String>, Stop> {
    let seeds: Vec<u64> = (0..BATCHES).map(|batch| batch_seed(bench.seed_of(spec), batch)).collect();
    let images = render(bench, spec, &seeds, result)?;
    if let Some((a, b)) = alike(&images) {
        result.details.insert("images that are the same".to_owned(), 1.0);
        return Ok(Some(format!(
            "different seeds give the same image (batches {a} and {b}): the random numbers are not those of the sampler"
        )));
    }
    // In a process of its own and in another order: nothing may be left over from what was rendered before.
    let reversed: Vec<u64> = seeds.iter().rev().copied().collect();
    let again = render(bench, spec, &reversed, result)?;
    if images.iter().ne(again.iter().rev()) {
        result.details.insert("images that are not repeatable".to_owned(), 1.0);
        return Ok(Some(
            "the same seed does not give the same image twice: either the random numbers are not those of the sampler, \
             or something is remembered from one path to the next"
                .to_owned(),
        ));
    }
    let first = found(&images);
    if first.p_value >= LEVEL {
        return Ok(None);
    }
    let fresh: Vec<u64> = seeds.iter().map(|&seed| batch_seed(seed, 1)).collect();
    let second = found(&render(bench, spec, &fresh, result)?);
    Ok((second.p_value < LEVEL).then(|| {
        result.details.insert("noise that pixels share".to_owned(), second.excess);
        format!(
            "pixels share their random numbers: the noise of {} is {:.1} times as large as that of independent pixels",
            second.of, second.excess
        )
    }))
}

fn render(
    bench: &Bench<'_>,
    spec: &CheckSpec,
    seeds: &[u64],
    result: &mut CheckResult,
) -> Result<Vec<Vec<[f32; 3]>>, Stop> {
    let mut process = bench.start()?;
    let scene = process.load(&bench.scene(spec).description)??;
    result.samples += seeds.len() as u64 * SAMPLES * u64::from(SIZE.0 * SIZE.1);
    let rendered = process.render(&RenderJob {
        scene,
        settings: Settings { technique: spec.technique, max_bounces: spec.max_bounces },
        width: SIZE.0,
        height: SIZE.1,
        seeds: seeds.to_vec(),
        first_sample: 0,
        samples: SAMPLES,
        switches: Switches::default(),
    })??;
    Ok(rendered.batches)
}

/// Two images that are the same, bit by bit. Images without any noise are the same rightly: black ones, say.
fn alike(images: &[Vec<[f32; 3]>]) -> Option<(usize, usize)> {
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
