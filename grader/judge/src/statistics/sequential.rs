//! Looking again and again, with more samples each time, until the verdict is clear.
//!
//! A difference is first **screened** for at a level that lets one correct submission in a hundred be looked at twice;
//! what was flagged is **confirmed** on fresh seeds with four times the samples, in the same region and direction, at
//! a level of 1e-4. Only then is it called a bias. So a correct submission fails about once in a million: if its noise
//! is like that of the solution, or its own samples show how much worse it is. Rare bright samples that have not come
//! in any pixel yet are beyond every test.

use arty::sampler::batch_seed;

use verdict::check::{RegionId, RegionKind};

use super::batches::Batches;
use super::bias::{Comparison, Expected, combined_p_value, min_p_value, normal_deviate};
use super::regions::{LEVELS, Region};

/// How often correct submissions may be flagged by screening, over everything that is looked at in one grade.
pub const SCREENING_LEVEL: f64 = 0.01;

/// The level of the confirmation.
pub const CONFIRMATION_LEVEL: f64 = 1e-4;

/// Independent renderings in each look.
const BATCHES: u64 = 32;

/// Samples of each pixel and batch that have been taken by each look.
///
/// With four times as many samples, the confirmation of the last one takes 32,768 of each pixel. A reference has four
/// times as many, and its own error is part of every comparison. The last look costs three times as much as all before
/// it together, so it is taken only where a pass is in sight.
pub const LOOKS: [u64; 5] = [1, 4, 16, 64, 256];

/// Looks before this one (counted from 0) are too early for a pass: small tiles see too little.
const FIRST_PASS: usize = 1;

/// Confidence of the interval that has to lie within the tolerance for a pass.
const PASS_CONFIDENCE: f64 = 0.999;

/// Samples that are wanted from the submission.
#[derive(Clone, Debug)]
pub struct SampleRequest {
    /// One per batch.
    pub seeds: Vec<u64>,
    /// Number of the first sample of each pixel.
    pub first_sample: u64,
    /// Samples of each pixel in each batch.
    pub samples: u64,
}

/// What is decided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Decision {
    /// The mean is wrong.
    Biased,
    /// The mean is right, within the tolerance.
    Unbiased,
    /// Too noisy for either.
    Unclear,
}

/// A decision with what it rests on.
#[derive(Clone, Debug)]
pub struct Judgement {
    /// What is decided.
    pub decision: Decision,
    /// The region that decided: the one that is biased, or else the whole image.
    pub region: RegionId,
    /// That region's last comparison.
    pub comparison: Comparison,
    /// The last comparison of the whole image.
    pub whole: Comparison,
    /// The smallest relative bias of the whole image that the samples would have shown.
    pub detectable: f64,
    /// Samples taken, over all pixels.
    pub samples: u64,
    /// For each tile of the finest level (row by row from the top) how many standard errors its luminance was off.
    pub z: Vec<f64>,
}

/// What to decide, and how surely.
#[derive(Clone, Copy, Debug)]
pub struct SequentialTest<'a> {
    /// What the image should be.
    pub expected: &'a Expected,
    /// Where to look.
    pub regions: &'a [Region],
    /// Which of them has to be right for a pass: the one whose mean is known best.
    pub decisive: usize,
    /// The relative bias of the whole image that must be excluded for a pass.
    pub tolerance: f64,
    /// The share of [`SCREENING_LEVEL`] that this test may spend.
    pub screening_level: f64,
    /// The seed of everything.
    pub seed: u64,
    /// How many of the [`LOOKS`] may be taken.
    pub looks: usize,
}

impl SequentialTest<'_> {
    /// The level at which one look flags a region.
    fn level_of_a_look(&self) -> f64 {
        self.screening_level / self.looks as f64
    }
}

/// Asks for samples until the test is decided, or no look is left that could decide it.
///
/// # Errors
/// What `render` fails with.
pub fn judge<E>(
    test: &SequentialTest<'_>,
    mut render: impl FnMut(&SampleRequest) -> Result<Vec<Vec<[f32; 3]>>, E>,
) -> Result<Judgement, E> {
    let pixels = test.expected.mean.len() as u64;
    let whole = &test.regions[test.decisive];
    let seeds = seeds(test.seed);
    let mut batches = Batches::default();
    let mut taken = 0;
    let mut confirmation_samples = 0;
    for (look, total) in LOOKS.into_iter().take(test.looks).enumerate() {
        let request = SampleRequest { seeds: seeds.clone(), first_sample: taken, samples: total - taken };
        batches.extend(&render(&request)?, request.samples);
        taken = total;
        let screening = Screening::new(test, &batches);
        let judgement = |decision, region: &Region, comparison, confirmation_samples| Judgement {
            decision,
            region: region.id,
            comparison,
            whole: screening.whole,
            detectable: screening.whole.detectable(CONFIRMATION_LEVEL),
            samples: (batches.samples_per_pixel() + confirmation_samples) * pixels,
            z: screening.z.clone(),
        };
        if screening.p_value < test.level_of_a_look() {
            let request = SampleRequest {
                seeds: self::seeds(batch_seed(test.seed, u64::MAX - look as u64)),
                first_sample: 0,
                samples: 4 * total,
            };
            let mut fresh = Batches::default();
            fresh.extend(&render(&request)?, request.samples);
            confirmation_samples += fresh.samples_per_pixel();
            let expected = test.expected.with_noise_of(&fresh);
            let comparison = Comparison::new(&fresh, &expected, &screening.suspect);
            let p_value = comparison.one_sided_p_value(screening.suspected_difference);
            if p_value < CONFIRMATION_LEVEL {
                return Ok(judgement(Decision::Biased, &screening.suspect, comparison, confirmation_samples));
            }
        }
        let worst = screening.whole.relative().abs() + screening.whole.relative_margin(PASS_CONFIDENCE);
        let clear = look >= FIRST_PASS && worst < test.tolerance;
        if clear {
            return Ok(judgement(Decision::Unbiased, whole, screening.whole, confirmation_samples));
        }
        let next = look + 1;
        let is_last = next == test.looks.min(LOOKS.len());
        if is_last || (next + 1 == LOOKS.len() && !within_reach(worst, test.tolerance)) {
            return Ok(judgement(Decision::Unclear, whole, screening.whole, confirmation_samples));
        }
    }
    unreachable!("the last look decides");
}

/// Whether a look with four times as many samples is likely to bring the worst that the error may be below the
/// tolerance: it will be about half as large, if the mean is right.
fn within_reach(worst: f64, tolerance: f64) -> bool {
    worst < 2.0 * tolerance
}

fn seeds(seed: u64) -> Vec<u64> {
    (0..BATCHES).map(|batch| batch_seed(seed, batch)).collect()
}

/// All regions at one look.
struct Screening {
    /// The probability that a correct submission looks this bad somewhere.
    p_value: f64,
    /// Where it looks worst.
    suspect: Region,
    /// The difference there.
    suspected_difference: f64,
    /// The region that has to be right for a pass.
    whole: Comparison,
    /// The normal deviates of the finest tiles.
    z: Vec<f64>,
}

impl Screening {
    fn new(test: &SequentialTest<'_>, batches: &Batches) -> Self {
        let regions = test.regions;
        let expected = test.expected.with_noise_of(batches);
        let compare = |region: &Region| Comparison::new(batches, &expected, region);
        let comparisons: Vec<Comparison> = regions.iter().map(compare).collect();
        let p_values: Vec<f64> = comparisons.iter().map(Comparison::p_value).collect();

        // The worst region of each level, for as many as were tried.
        let mut tests: Vec<(f64, Region, f64)> = Vec::new();
        for level in 0..LEVELS {
            let tried: Vec<usize> = (0..regions.len()).filter(|&i| regions[i].level == level).collect();
            if let Some(&worst) = tried.iter().min_by(|&&a, &&b| p_values[a].total_cmp(&p_values[b])) {
                let p_value = min_p_value(tried.len(), p_values[worst]);
                tests.push((p_value, regions[worst].clone(), comparisons[worst].difference));
            }
        }
        // All tiles of the finest level at once, and the pattern of their differences as a region of its own.
        let finest = regions.iter().map(|region| region.level).max().unwrap_or(0);
        let tiles: Vec<usize> = (0..regions.len())
            .filter(|&i| regions[i].level == finest && regions[i].id.kind == RegionKind::Luminance)
            .collect();
        let z =
            tiles.iter().map(|&i| normal_deviate(p_values[i]) * comparisons[i].difference.signum()).collect();
        if tiles.len() > 1 {
            let p_value = combined_p_value(&tiles.iter().map(|&i| p_values[i]).collect::<Vec<_>>());
            tests.push((p_value, pattern(regions, &comparisons, &tiles), 1.0));
        }

        let whole = test.decisive;
        // The coarsest region that is flagged says most simply what is wrong; without one, the least likely.
        let count = tests.len() as f64;
        let flagged = |p_value: f64| count * p_value < test.level_of_a_look();
        let worst = match tests.iter().position(|(p_value, ..)| flagged(*p_value)) {
            Some(first) => Some(tests.swap_remove(first)),
            None => tests.into_iter().min_by(|a, b| a.0.total_cmp(&b.0)),
        };
        let (p_value, suspect, suspected_difference) =
            worst.unwrap_or_else(|| (1.0, regions[whole].clone(), 0.0));
        Self {
            p_value: (count * p_value).min(1.0),
            suspect,
            suspected_difference,
            whole: comparisons[whole],
            z,
        }
    }
}

/// The sum of the tiles, each weighted by how far it was off: fresh samples of a true bias make it positive again.
fn pattern(regions: &[Region], comparisons: &[Comparison], tiles: &[usize]) -> Region {
    let deviation = |i: usize| comparisons[i].t() * comparisons[i].difference.signum();
    let norm: f64 = tiles.iter().map(|&i| deviation(i).abs()).sum::<f64>().max(f64::MIN_POSITIVE);
    // Tiles of one level do not overlap.
    let scaled = |i: usize| {
        let factor = deviation(i) / norm;
        regions[i].weights.iter().map(move |(pixel, weights)| (*pixel, weights.map(|weight| weight * factor)))
    };
    let weights = tiles.iter().flat_map(|&i| scaled(i)).collect();
    Region {
        id: RegionId { kind: RegionKind::Pattern, pixels: None },
        level: regions[tiles[0]].level,
        weights,
    }
}

#[cfg(test)]
mod tests {
    use super::super::regions::pyramid;
    use super::*;
    use arty::sampler::Sampler;

    /// Exponentially distributed samples around a mean, as an estimator that is right or wrong by a factor.
    fn exponential(
        factor: f64,
        corner_factor: f64,
    ) -> impl FnMut(&SampleRequest) -> Result<Vec<Vec<[f32; 3]>>, ()> {
        move |request| {
            let batch = |&seed: &u64| {
                let pixel = |i: u32| {
                    let samples = request.first_sample..request.first_sample + request.samples;
                    let sum: f64 = samples
                        .map(|sample| {
                            let u = Sampler::new(seed, (i, 0), sample).next_1d();
                            -f64::from(1.0 - u).ln()
                        })
                        .sum();
                    let factor = if i < 2 { factor * corner_factor } else { factor };
                    [(factor * sum / request.samples as f64) as f32; 3]
                };
                (0..256).map(pixel).collect()
            };
            Ok(request.seeds.iter().map(batch).collect())
        }
    }

    /// Samples with a mean of 1, most of them black: each is 0, or once in `scarcity` times as bright as that.
    fn judge_sparse(scarcity: f64, tolerance: f64, seed: u64) -> Judgement {
        let expected = Expected {
            mean: vec![[1.0; 3]; 256],
            error: vec![[0.0; 3]; 256],
            deviation: vec![[(scarcity - 1.0).sqrt(); 3]; 256],
            asymmetry: vec![[scarcity.powf(2.0 / 3.0); 3]; 256],
        };
        let render = |request: &SampleRequest| {
            let batch = |&seed: &u64| {
                let pixel = |i: u32| {
                    let samples = request.first_sample..request.first_sample + request.samples;
                    let is_bright = |&sample: &u64| {
                        f64::from(Sampler::new(seed, (i, 0), sample).next_1d()) < 1.0 / scarcity
                    };
                    let bright = samples.filter(is_bright).count() as f64;
                    [(bright * scarcity / request.samples as f64) as f32; 3]
                };
                (0..256).map(pixel).collect()
            };
            Ok::<_, ()>(request.seeds.iter().map(batch).collect())
        };
        ask(&expected, tolerance, seed, render)
    }

    fn judge_exponential(factor: f64, corner_factor: f64, seed: u64) -> Judgement {
        let expected = Expected {
            mean: vec![[1.0; 3]; 256],
            error: vec![[0.0; 3]; 256],
            deviation: vec![[1.0; 3]; 256],
            asymmetry: vec![[2.0f64.cbrt(); 3]; 256],
        };
        ask(&expected, 0.02, seed, exponential(factor, corner_factor))
    }

    fn ask(
        expected: &Expected,
        tolerance: f64,
        seed: u64,
        render: impl FnMut(&SampleRequest) -> Result<Vec<Vec<[f32; 3]>>, ()>,
    ) -> Judgement {
        let regions = pyramid(16, 16);
        let test = SequentialTest {
            expected,
            regions: &regions,
            decisive: 3,
            tolerance,
            screening_level: 0.01,
            seed,
            looks: LOOKS.len(),
        };
        judge(&test, render).expect("it cannot fail")
    }

    #[test]
    fn a_correct_estimator_passes() {
        // Nominal false-alarm rate 1e-6 each: 2e-5 over the twenty fixed seeds.
        for seed in 0..20 {
            let judgement = judge_exponential(1.0, 1.0, seed);
            assert_eq!(judgement.decision, Decision::Unbiased, "seed {seed}: {judgement:?}");
        }
    }

    #[test]
    fn a_biased_estimator_is_caught_early_if_the_bias_is_large() {
        for (factor, max_samples) in [(1.03, 1_000_000), (0.9, 300_000), (2.0, 50_000), (0.0, 50_000)] {
            for seed in 0..10 {
                let judgement = judge_exponential(factor, 1.0, seed);
                assert_eq!(judgement.decision, Decision::Biased, "× {factor}, seed {seed}: {judgement:?}");
                assert!(judgement.samples <= max_samples, "× {factor}: {}", judgement.samples);
            }
        }
    }

    #[test]
    fn the_last_look_is_taken_where_it_decides_and_nowhere_else() {
        // Of 256 pixels with samples of deviation 14, 3.6 × 14 / √(256 · 32 · 64) = 7 % can hide before the last look
        // and half as much after it; with a deviation of 100, 50 % and 25 %. The means are within 3 σ, 6 % and 3 %,
        // but once in 400.
        let pixels = 256;
        let samples = |judgement: &Judgement| judgement.samples / pixels / BATCHES;
        for seed in 0..5 {
            let near = judge_sparse(200.0, 0.065, seed);
            assert_eq!(near.decision, Decision::Unbiased, "seed {seed}: {near:?}");
            assert!(samples(&near) >= LOOKS[4], "seed {seed}");
            let far = judge_sparse(10_000.0, 0.065, seed);
            assert_eq!(far.decision, Decision::Unclear, "seed {seed}: {far:?}");
            assert_eq!(samples(&far), LOOKS[3], "seed {seed}");
        }
    }

    #[test]
    fn a_mistake_in_one_corner_is_found_there() {
        for seed in 0..10 {
            let judgement = judge_exponential(1.0, 0.5, seed);
            assert_eq!(judgement.decision, Decision::Biased, "seed {seed}");
        }
    }
}
