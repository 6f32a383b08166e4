//! The sequential test for bias: looks with more and more samples until the result is clear.
//!
//! A difference is first **screened** at a level that flags one correct submission in a hundred. A flagged difference
//! is **confirmed** with fresh seeds and four times the samples, in the same region and direction, at a level of 1e-4.
//! Only then it is called a bias. Hence a correct submission fails about once in a million grades, provided that its
//! noise is like that of the solution, or that its own samples show how much noisier it is. No test can detect rare
//! bright samples that have not occurred in any pixel yet.

use arty::sampler::batch_seed;

use verdict::check::{RegionId, RegionKind};

use super::batches::Batches;
use super::bias::{Comparison, combined_p_value, min_p_value, normal_deviate};
use super::expected::Expected;
use super::regions::{LEVELS, Region};

/// Probability that screening flags a correct submission, over all pictures of one grade.
pub const SCREENING_LEVEL: f64 = 0.01;

/// Significance level of the confirmation.
pub const CONFIRMATION_LEVEL: f64 = 1e-4;

/// Number of batches of each look.
const BATCHES: u64 = 32;

/// Samples per pixel and batch after each look.
///
/// The confirmation of the last look takes four times as many, 32,768 per pixel. A reference has four times as many
/// again, and its own error is part of every comparison. The last look costs three times as much as all earlier ones
/// together, so that it is taken only if a pass is likely.
pub const LOOKS: [u64; 5] = [1, 4, 16, 64, 256];

/// Index of the first look that may pass a submission: earlier ones detect too little in small tiles.
const FIRST_PASS: usize = 1;

/// Confidence of the interval that must lie within the tolerance for a pass.
const PASS_CONFIDENCE: f64 = 0.999;

/// Samples requested from the submission.
#[derive(Clone, Debug)]
pub struct SampleRequest {
    /// One seed per batch.
    pub seeds: Vec<u64>,
    /// Index of the first sample of each pixel.
    pub first_sample: u64,
    /// Samples per pixel and batch.
    pub samples: u64,
}

/// The decision of the test.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Decision {
    /// The mean is wrong.
    Biased,
    /// The mean is right, within the tolerance.
    Unbiased,
    /// Too noisy to decide.
    Unclear,
}

/// A decision with its evidence.
#[derive(Clone, Debug)]
pub struct Judgement {
    /// The decision.
    pub decision: Decision,
    /// The region that decided: the biased one, or else the whole image.
    pub region: RegionId,
    /// Last comparison of that region.
    pub comparison: Comparison,
    /// Last comparison of the whole image.
    pub whole: Comparison,
    /// Smallest relative bias of the whole image that the samples would have detected.
    pub detectable: f64,
    /// Number of samples over all pixels, confirmations included.
    pub samples: u64,
    /// Normal deviate of the luminance of each tile of the finest level, row by row from the top.
    pub z: Vec<f64>,
}

/// Parameters of a sequential test.
#[derive(Clone, Copy, Debug)]
pub struct SequentialTest<'a> {
    /// Expected mean and noise.
    pub expected: &'a Expected,
    /// Regions to test.
    pub regions: &'a [Region],
    /// Index of the region whose mean decides about a pass: the one with the lowest variance.
    pub decisive: usize,
    /// Relative bias of the whole image that a pass excludes.
    pub tolerance: f64,
    /// Screening level of this test, a share of [`SCREENING_LEVEL`].
    pub screening_level: f64,
    /// Seed of all samples.
    pub seed: u64,
    /// Maximum number of [`LOOKS`].
    pub looks: usize,
}

impl SequentialTest<'_> {
    /// Significance level of the screening at one look.
    fn level_per_look(&self) -> f64 {
        self.screening_level / self.looks as f64
    }
}

/// Runs the test: requests samples until it can decide, or no further look would.
///
/// # Errors
/// Those of `render`.
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
        if screening.p_value < test.level_per_look() {
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

/// True if the next look, with four times the samples, is likely to reduce the upper bound of the error below the
/// tolerance: the bound about halves if the mean is right.
fn within_reach(worst: f64, tolerance: f64) -> bool {
    worst < 2.0 * tolerance
}

fn seeds(seed: u64) -> Vec<u64> {
    (0..BATCHES).map(|batch| batch_seed(seed, batch)).collect()
}

/// Screening of all regions at one look.
struct Screening {
    /// p-value of the worst deviation, corrected for the number of tests.
    p_value: f64,
    /// The region with that deviation.
    suspect: Region,
    /// The difference in that region.
    suspected_difference: f64,
    /// Comparison of the decisive region.
    whole: Comparison,
    /// Normal deviates of the tiles of the finest level.
    z: Vec<f64>,
}

impl Screening {
    fn new(test: &SequentialTest<'_>, batches: &Batches) -> Self {
        let regions = test.regions;
        let expected = test.expected.with_noise_of(batches);
        let compare = |region: &Region| Comparison::new(batches, &expected, region);
        let comparisons: Vec<Comparison> = regions.iter().map(compare).collect();
        let p_values: Vec<f64> = comparisons.iter().map(Comparison::p_value).collect();

        // The worst region of each level, corrected for their number.
        let mut tests: Vec<(f64, Region, f64)> = Vec::new();
        for level in 0..LEVELS {
            let tried: Vec<usize> = (0..regions.len()).filter(|&i| regions[i].level == level).collect();
            if let Some(&worst) = tried.iter().min_by(|&&a, &&b| p_values[a].total_cmp(&p_values[b])) {
                let p_value = min_p_value(tried.len(), p_values[worst]);
                tests.push((p_value, regions[worst].clone(), comparisons[worst].difference));
            }
        }
        // All tiles of the finest level combined, with the pattern of their differences as the suspect region.
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
        // Report the coarsest flagged region, which is easiest to understand, or else the one with the lowest p-value.
        let count = tests.len() as f64;
        let flagged = |p_value: f64| count * p_value < test.level_per_look();
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

/// The sum of the tiles weighted by their deviations: with a true bias, fresh samples make it positive again.
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

    /// Renders exponentially distributed samples whose mean is wrong by a factor, and by another one in a corner.
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

    /// Tests samples with a mean of 1 of which one in `scarcity` has the value `scarcity` and all others are 0.
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
    fn a_large_bias_is_detected_early() {
        for (factor, max_samples) in [(1.03, 1_000_000), (0.9, 300_000), (2.0, 50_000), (0.0, 50_000)] {
            for seed in 0..10 {
                let judgement = judge_exponential(factor, 1.0, seed);
                assert_eq!(judgement.decision, Decision::Biased, "× {factor}, seed {seed}: {judgement:?}");
                assert!(judgement.samples <= max_samples, "× {factor}: {}", judgement.samples);
            }
        }
    }

    #[test]
    fn the_last_look_is_taken_only_where_it_may_decide() {
        // With 256 pixels and samples of standard deviation 14, the interval before the last look is 3.6 × 14 / √(256
        // · 32 · 64) = 7 % wide, and half of that after it; with a deviation of 100, it is 50 % and 25 %. The means
        // are within 3 σ, 6 % and 3 %, except once in 400.
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
    fn a_bias_in_one_corner_is_detected() {
        for seed in 0..10 {
            let judgement = judge_exponential(1.0, 0.5, seed);
            assert_eq!(judgement.decision, Decision::Biased, "seed {seed}");
        }
    }
}
