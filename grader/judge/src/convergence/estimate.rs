//! Estimating errors with intervals from renderings.
//!
//! With renderings x_b and reference r, all estimates are functions of the products G_bc = mean(w·(x_b − r)(x_c − r))
//! over pixels and channels. The diagonal gives the MSE; the other products, of **different** renderings with
//! independent noise, give the squared bias without variance.

use arty::sampler::{Sampler, batch_seed};

use crate::image_error::{Truth, relative_weight, trimmed_relative_mse};
use verdict::convergence::{Estimate, Point};

/// Number of bootstrap replicates.
pub(super) const REPLICATES: usize = 400;

/// Separate renderings of one length.
#[derive(Clone, Debug, Default)]
pub(super) struct Renders {
    /// Samples per pixel of each rendering.
    pub(super) samples: u64,
    /// Processor time of one rendering, in seconds.
    pub(super) seconds: f64,
    /// Pixels of each rendering.
    pub(super) images: Vec<Vec<[f64; 3]>>,
}

/// A point of a curve, with its relative MSE in each of the [`REPLICATES`].
pub(super) struct PointEstimate {
    pub(super) point: Point,
    pub(super) replicates: Vec<f64>,
}

/// Estimates the errors of renderings of one length; `None` for fewer than two renderings.
pub(super) fn estimate(renders: &Renders, truth: Truth<'_>, seed: u64) -> Option<PointEstimate> {
    let count = renders.images.len();
    if count < 2 {
        return None;
    }
    let images: Vec<&[[f64; 3]]> = renders.images.iter().map(Vec::as_slice).collect();
    let absolute = ErrorProducts::new(&images, truth, |_| 1.0);
    let relative = ErrorProducts::new(&images, truth, relative_weight);
    let trimmed: Vec<f64> = images.iter().map(|image| trimmed_relative_mse(image, truth)).collect();
    let weighted = |weights: &[f64]| -> [f64; 5] {
        let total: f64 = weights.iter().sum();
        let mean_trimmed =
            trimmed.iter().zip(weights).map(|(error, weight)| error * weight).sum::<f64>() / total;
        let (mse, bias_squared) = (absolute.mse(weights), absolute.bias_squared(weights));
        [relative.mse(weights), mean_trimmed, mse, bias_squared, mse - bias_squared]
    };
    let values = weighted(&vec![1.0; count]);
    let drawn: Vec<[f64; 5]> =
        BootstrapDraws::new(seed, &[count]).map(|weights| weighted(&weights)).collect();
    let [relative_mse, trimmed_relative_mse, mse, bias_squared, variance] = std::array::from_fn(|index| {
        with_percentiles(values[index], drawn.iter().map(|values| values[index]).collect())
    });
    let Renders { samples, seconds, .. } = *renders;
    let renders = count;
    let point =
        Point { samples, renders, seconds, relative_mse, trimmed_relative_mse, mse, bias_squared, variance };
    Some(PointEstimate { point, replicates: drawn.into_iter().map(|values| values[0]).collect() })
}

/// Estimates the relative squared bias from renderings of all lengths, weighted by their samples. Also returns its
/// bootstrap standard deviation. `None` for fewer than two renderings.
pub(super) fn relative_bias_squared(
    levels: &[Renders],
    truth: Truth<'_>,
    seed: u64,
) -> Option<(Estimate, f64)> {
    let images: Vec<&[[f64; 3]]> = levels.iter().flat_map(|level| &level.images).map(Vec::as_slice).collect();
    let samples: Vec<f64> =
        levels.iter().flat_map(|level| level.images.iter().map(|_| level.samples as f64)).collect();
    if images.len() < 2 {
        return None;
    }
    let products = ErrorProducts::new(&images, truth, relative_weight);
    let value = products.bias_squared(&samples);
    let sizes: Vec<usize> = levels.iter().map(|level| level.images.len()).filter(|&size| size > 0).collect();
    let drawn: Vec<f64> = BootstrapDraws::new(seed, &sizes)
        .map(|weights| {
            let weights: Vec<f64> =
                weights.iter().zip(&samples).map(|(weight, samples)| weight * samples).collect();
            products.bias_squared(&weights)
        })
        .collect();
    let mean = drawn.iter().sum::<f64>() / drawn.len() as f64;
    let variance = drawn.iter().map(|drawn| (drawn - mean).powi(2)).sum::<f64>() / drawn.len() as f64;
    Some((with_percentiles(value, drawn), variance.sqrt()))
}

/// An estimate with the 95 % percentile interval of its replicates, ignoring NaN.
pub(super) fn with_percentiles(value: f64, mut replicates: Vec<f64>) -> Estimate {
    replicates.retain(|value| !value.is_nan());
    replicates.sort_unstable_by(f64::total_cmp);
    let at = |share: f64| {
        let index = (share * replicates.len().saturating_sub(1) as f64).round() as usize;
        replicates.get(index).copied().unwrap_or(value)
    };
    Estimate { value, interval: [at(0.025), at(0.975)] }
}

/// The products G_bc of the errors of all pairs of renderings.
struct ErrorProducts {
    count: usize,
    pairs: Vec<f64>,
    /// Contribution of the reference's noise to each product.
    noise: f64,
}

impl ErrorProducts {
    fn new(images: &[&[[f64; 3]]], truth: Truth<'_>, weight: fn(f64) -> f64) -> Self {
        let roots: Vec<f64> = truth.mean.iter().flatten().map(|&value| weight(value).sqrt()).collect();
        let size = roots.len().max(1) as f64;
        let errors: Vec<Vec<f64>> = images
            .iter()
            .map(|image| {
                let differences = image.iter().flatten().zip(truth.mean.iter().flatten());
                differences.zip(&roots).map(|((x, r), root)| root * (x - r)).collect()
            })
            .collect();
        let count = images.len();
        let mut pairs = vec![0.0; count * count];
        for first in 0..count {
            for second in first..count {
                let product: f64 = errors[first].iter().zip(&errors[second]).map(|(a, b)| a * b).sum();
                pairs[first * count + second] = product / size;
                pairs[second * count + first] = product / size;
            }
        }
        let noise = truth.variance.map_or(0.0, |variance| {
            variance.iter().flatten().zip(&roots).map(|(variance, root)| root * root * variance).sum::<f64>()
                / size
        });
        Self { count, pairs, noise }
    }

    /// The weighted mean squared error.
    fn mse(&self, weights: &[f64]) -> f64 {
        let sum: f64 = (0..self.count).map(|b| weights[b] * self.pairs[b * self.count + b]).sum();
        sum / weights.iter().sum::<f64>() - self.noise
    }

    /// The weighted squared bias, over pairs of different renderings. NaN if only one rendering has a weight.
    fn bias_squared(&self, weights: &[f64]) -> f64 {
        let (mut sum, mut total) = (0.0, 0.0);
        for (first, &weight) in weights.iter().enumerate().filter(|(_, weight)| **weight != 0.0) {
            for (second, other) in weights.iter().enumerate().skip(first + 1) {
                sum += weight * other * self.pairs[first * self.count + second];
                total += weight * other;
            }
        }
        sum / total - self.noise
    }
}

/// Bootstrap replicates: the number of times that each rendering is drawn. Renderings are drawn within their own
/// length.
struct BootstrapDraws<'a> {
    seed: u64,
    sizes: &'a [usize],
    drawn: usize,
}

impl<'a> BootstrapDraws<'a> {
    fn new(seed: u64, sizes: &'a [usize]) -> Self {
        Self { seed, sizes, drawn: 0 }
    }
}

impl Iterator for BootstrapDraws<'_> {
    type Item = Vec<f64>;

    fn next(&mut self) -> Option<Vec<f64>> {
        if self.drawn == REPLICATES {
            return None;
        }
        let mut sampler = Sampler::new(batch_seed(self.seed, self.drawn as u64), (0, 0), 0);
        self.drawn += 1;
        let mut weights = Vec::new();
        for &size in self.sizes {
            let start = weights.len();
            weights.resize(start + size, 0.0);
            for _ in 0..size {
                weights[start + (f64::from(sampler.next_1d()) * size as f64) as usize] += 1.0;
            }
        }
        Some(weights)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PIXELS: usize = 256;

    /// Renderings of a constant picture of 1, with the given bias and standard deviation (uniform noise).
    fn renders(count: usize, bias: f64, deviation: f64, seed: u64) -> Renders {
        let mut sampler = Sampler::new(seed, (0, 0), 0);
        let width = deviation * 12.0_f64.sqrt();
        let mut value = || 1.0 + bias + width * (f64::from(sampler.next_1d()) - 0.5);
        let images =
            (0..count).map(|_| (0..PIXELS).map(|_| std::array::from_fn(|_| value())).collect()).collect();
        Renders { samples: 4, seconds: 0.5, images }
    }

    /// The number of 100 repetitions in which the 95 % interval contains the true value.
    fn coverage(select: fn(&Point) -> Estimate, truth: f64) -> usize {
        let reference = [[1.0; 3]; PIXELS];
        let holds = |seed: u64| {
            let renders = renders(24, 0.1, 0.5, seed);
            let estimated =
                estimate(&renders, Truth { mean: &reference, variance: None }, seed).expect("many");
            let [low, high] = select(&estimated.point).interval;
            low <= truth && truth <= high
        };
        (0..100).filter(|&seed| holds(seed)).count()
    }

    #[test]
    fn bias_and_variance_are_separated_and_intervals_have_coverage() {
        // A percentile interval of 24 renderings covers about 92 of 100; 80 or fewer has a chance below 1e-3.
        assert!(coverage(|point| point.mse, 0.01 + 0.25) > 80);
        assert!(coverage(|point| point.bias_squared, 0.01) > 80);
        assert!(coverage(|point| point.variance, 0.25) > 80);
        assert!(coverage(|point| point.relative_mse, 0.26 / 1.01) > 80);
    }

    #[test]
    fn the_noise_of_the_reference_is_not_bias() {
        let (mean, variance) = ([[0.9; 3]; PIXELS], [[0.01; 3]; PIXELS]);
        let renders = renders(16, 0.0, 0.1, 3);
        let without = estimate(&renders, Truth { mean: &mean, variance: None }, 1).expect("many").point;
        assert!((without.bias_squared.value - 0.01).abs() < 0.002, "{:?}", without.bias_squared);
        let with =
            estimate(&renders, Truth { mean: &mean, variance: Some(&variance) }, 1).expect("many").point;
        assert!(with.bias_squared.value.abs() < 0.002, "{:?}", with.bias_squared);
    }

    #[test]
    fn a_bias_is_found_in_renderings_of_several_lengths() {
        let reference = [[1.0; 3]; PIXELS];
        let truth = Truth { mean: &reference, variance: None };
        let found = |bias: f64| {
            let levels = [renders(12, bias, 0.5, 1), Renders { samples: 16, ..renders(6, bias, 0.25, 2) }];
            relative_bias_squared(&levels, truth, 1).expect("many")
        };
        let (biased, deviation) = found(0.1);
        assert!((biased.value * 1.01 - 0.01).abs() < 0.002 && biased.value > 4.0 * deviation, "{biased:?}");
        let (unbiased, deviation) = found(0.0);
        assert!(unbiased.value < 4.0 * deviation, "{unbiased:?} {deviation}");
    }

    #[test]
    fn one_rendering_has_no_estimate() {
        let reference = [[1.0; 3]; PIXELS];
        let truth = Truth { mean: &reference, variance: None };
        assert!(estimate(&renders(1, 0.0, 0.1, 1), truth, 1).is_none());
        assert!(relative_bias_squared(&[renders(1, 0.0, 0.1, 1)], truth, 1).is_none());
    }
}
