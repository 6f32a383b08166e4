//! Whether a curve is biased: the judge's own test decides, with samples of its own.

use arty::integrator::Settings;
use arty::sampler::batch_seed;
use host::protocol::RenderJob;

use crate::image_error::{Truth, relative_weight};
use crate::reference::SIZE;
use crate::statistics::expected::Expected;
use crate::statistics::regions::{pyramid, weighted_image};
use crate::statistics::sequential::{Decision, LOOKS, SCREENING_LEVEL, SequentialTest, judge};
use harness::host_process::HostProcess;
use harness::job::JobError;
use verdict::convergence::Bias;

/// Number of batches of one look (see [`judge`]).
const BATCHES: f64 = 32.0;

/// Relative bias of the whole image below which the test ends early.
const TOLERANCE: f64 = 0.003;

/// Number of looks that take at most `seconds` without a confirmation, if a sample per pixel takes `per_sample` seconds.
/// At least two.
pub(super) fn looks(seconds: f64, per_sample: f64) -> usize {
    let affordable = |&&samples: &&u64| BATCHES * samples as f64 * per_sample <= seconds;
    LOOKS.iter().take_while(affordable).count().max(2)
}

/// Tests the mean of a program's pictures. `relative_squared` is its estimated relative squared bias.
///
/// # Errors
/// If the program or the grader fails.
pub(super) fn test(
    process: &mut HostProcess,
    expected: &Expected,
    settings: Settings,
    seed: u64,
    looks: usize,
    relative_squared: f64,
) -> Result<Bias, JobError> {
    let mut regions = pyramid(SIZE.0, SIZE.1);
    regions.push(weighted_image(expected));
    let test = SequentialTest {
        expected,
        regions: &regions,
        decisive: regions.len() - 1,
        tolerance: TOLERANCE,
        screening_level: SCREENING_LEVEL,
        seed: batch_seed(seed, u64::MAX - 1),
        looks,
    };
    let judgement = judge(&test, |request| {
        let job = RenderJob::new(0, settings, [SIZE.0, SIZE.1], request.seeds.clone(), request.samples);
        Ok::<_, JobError>(process.render(&RenderJob { first_sample: request.first_sample, ..job })?.batches)
    })?;
    Ok(match judgement.decision {
        Decision::Biased => Bias::Found { relative_squared: relative_squared.max(0.0) },
        _ => Bias::NotFound { detectable: Some(judgement.detectable).filter(|bias| bias.is_finite()) },
    })
}

/// Estimates the relative squared bias without variance: mean(w·(x̄ − r)(ȳ − r)) over pixels and channels, where x̄ and ȳ
/// are the means of two halves of all renderings.
#[derive(Clone, Debug, Default)]
pub(super) struct MeanProduct {
    /// For each half the weighted sum of the images, and the sum of the weights.
    halves: [(Vec<[f64; 3]>, f64); 2],
}

impl MeanProduct {
    /// Adds a rendering with its number of samples to one of the halves.
    pub(super) fn add(&mut self, half: usize, image: &[[f64; 3]], samples: f64) {
        let (sum, total) = &mut self.halves[half];
        sum.resize(image.len(), [0.0; 3]);
        for (sum, value) in sum.iter_mut().flatten().zip(image.iter().flatten()) {
            *sum += samples * value;
        }
        *total += samples;
    }

    /// The estimate, which may be negative; `None` unless both halves have a rendering.
    pub(super) fn relative(&self, truth: Truth<'_>) -> Option<f64> {
        let [(first, first_total), (second, second_total)] = &self.halves;
        let pairs = first.iter().flatten().zip(second.iter().flatten()).zip(truth.mean.iter().flatten());
        let product = |((x, y), r): ((&f64, &f64), &f64)| {
            relative_weight(*r) * (x / first_total - r) * (y / second_total - r)
        };
        let noise = truth.variance.map_or(0.0, |variance| {
            let values = variance.iter().flatten().zip(truth.mean.iter().flatten());
            values.map(|(variance, &r)| relative_weight(r) * variance).sum()
        });
        let is_known = *first_total > 0.0 && *second_total > 0.0;
        is_known.then(|| (pairs.map(product).sum::<f64>() - noise) / (3 * truth.mean.len()).max(1) as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_squared_bias_has_no_share_of_the_variance_and_of_the_references_noise() {
        let mean = [[1.0; 3]; 2];
        let mut product = MeanProduct::default();
        assert_eq!(product.relative(Truth { mean: &mean, variance: None }), None);
        // Both halves are 0.1 too bright on average, with noise of opposite sign in the two pixels.
        for (half, noise) in [(0, 0.5), (1, -0.5)] {
            product.add(half, &[[1.1 + noise; 3], [1.1; 3]], 4.0);
            product.add(half, &[[1.1 - noise; 3], [1.1; 3]], 4.0);
        }
        let bias = |variance| product.relative(Truth { mean: &mean, variance }).expect("two halves");
        assert!((bias(None) - 0.01 / 1.01).abs() < 1e-12);
        assert!((bias(Some(&[[0.002; 3]; 2])) - 0.008 / 1.01).abs() < 1e-12);
    }

    #[test]
    fn more_time_gives_more_looks() {
        assert_eq!((looks(0.0, 1e-3), looks(0.6, 1e-3), looks(1e9, 1e-3)), (2, 3, 5));
    }
}
