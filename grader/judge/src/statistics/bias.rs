//! Test for bias of the mean of a region.

use statrs::distribution::{ChiSquared, ContinuousCDF, Normal, StudentsT};

use super::batches::Batches;
use super::expected::Expected;
use super::regions::Region;

/// Relative difference that is attributed to rounding in single precision, not to bias.
pub const TOLERATED: f64 = 1e-3;

/// The mean of one region of one rendering, compared with its expectation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comparison {
    /// Measured mean minus expected mean.
    pub difference: f64,
    /// Standard error of `difference`.
    pub standard_error: f64,
    /// Scale of relative differences: the expected mean with the absolute values of all weights.
    pub scale: f64,
    /// Degrees of freedom of `standard_error`.
    pub degrees_of_freedom: f64,
    /// False if a correct estimator is so skewed here that the mean of this many samples is not yet close to normal.
    /// Then Chebyshev's inequality replaces Student's distribution: it holds for any distribution with a known
    /// variance.
    pub normal: bool,
}

impl Comparison {
    /// Compares the batches with the expectation over one region.
    ///
    /// SE² = max(s²/B, σ²/N) + v: the variance between batches, but at least that of a correct estimator, since s is
    /// far too small if no batch has sampled a heavy tail yet; plus the variance of the reference.
    pub fn new(batches: &Batches, expected: &Expected, region: &Region) -> Self {
        let count = batches.count() as f64;
        let values: Vec<f64> = batches.contrast(region).collect();
        let mean = values.iter().sum::<f64>() / count;
        let spread = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (count - 1.0).max(1.0);

        // Pixels are independent. The channels of one pixel are not: the worst case is full correlation.
        let samples = batches.samples_per_pixel() as f64;
        let (mut expected_mean, mut scale) = (0.0, 0.0);
        let (mut reference_variance, mut floor, mut third_moment) = (0.0, 0.0, 0.0);
        for &(pixel, weights) in &region.weights {
            let sum = |values: &[f64; 3]| -> f64 { (0..3).map(|c| weights[c].abs() * values[c]).sum() };
            expected_mean += (0..3).map(|c| weights[c] * expected.mean[pixel][c]).sum::<f64>();
            scale += sum(&expected.mean[pixel]);
            reference_variance += sum(&expected.error[pixel]).powi(2);
            floor += sum(&expected.deviation[pixel]).powi(2);
            third_moment += sum(&expected.asymmetry[pixel]).powi(3);
        }
        let skewness = if floor > 0.0 { third_moment / floor.powf(1.5) } else { 0.0 };
        Self {
            difference: mean - expected_mean,
            standard_error: ((spread / count).max(floor / samples) + reference_variance).sqrt(),
            scale,
            degrees_of_freedom: (count - 1.0).max(1.0),
            // With N ≥ 411 γ² the tails are accurate at the confirmation level.
            normal: samples >= 411.0 * skewness * skewness,
        }
    }

    /// |difference| in excess of rounding, in standard errors; zero if there is no such excess.
    pub fn t(&self) -> f64 {
        let excess = (self.difference.abs() - TOLERATED * self.scale).max(0.0);
        if excess == 0.0 { 0.0 } else { excess / self.standard_error }
    }

    /// Two-sided p-value: the probability of a `t` at least this large for a correct estimator.
    pub fn p_value(&self) -> f64 {
        let t = self.t();
        if self.normal { 2.0 * upper_tail(t, self.degrees_of_freedom) } else { (1.0 / (t * t)).min(1.0) }
    }

    /// One-sided p-value, in the direction of the sign of `direction`.
    pub fn one_sided_p_value(&self, direction: f64) -> f64 {
        let t = self.t();
        if self.difference * direction <= 0.0 {
            1.0
        } else if self.normal {
            upper_tail(t, self.degrees_of_freedom)
        } else {
            1.0 / (1.0 + t * t)
        }
    }

    /// The number of standard errors that is exceeded with probability `tail` in one direction.
    fn quantile(&self, tail: f64) -> f64 {
        if self.normal { quantile(1.0 - tail, self.degrees_of_freedom) } else { (1.0 / tail - 1.0).sqrt() }
    }

    /// Difference relative to [`scale`](Self::scale).
    pub fn relative(&self) -> f64 {
        ratio(self.difference, self.scale)
    }

    /// Half the width of the confidence interval of the relative difference.
    pub fn relative_margin(&self, confidence: f64) -> f64 {
        ratio(self.quantile(0.5 * (1.0 - confidence)) * self.standard_error, self.scale)
    }

    /// The smallest relative bias that a test at level `alpha` detects with probability 0.99.
    pub fn detectable(&self, alpha: f64) -> f64 {
        let margin = self.quantile(0.5 * alpha) + self.quantile(0.01);
        TOLERATED + ratio(margin * self.standard_error, self.scale)
    }
}

/// `value / scale`, where 0/0 is 0.
fn ratio(value: f64, scale: f64) -> f64 {
    if value == 0.0 { 0.0 } else { value / scale }
}

/// P(T ≥ t) of Student's distribution.
fn upper_tail(t: f64, degrees_of_freedom: f64) -> f64 {
    if t.is_infinite() {
        return 0.0; // A difference without any variance.
    }
    StudentsT::new(0.0, 1.0, degrees_of_freedom).map_or(1.0, |distribution| distribution.sf(t))
}

fn quantile(p: f64, degrees_of_freedom: f64) -> f64 {
    StudentsT::new(0.0, 1.0, degrees_of_freedom)
        .map_or(f64::INFINITY, |distribution| distribution.inverse_cdf(p))
}

/// The p-value of the minimum `p` of `count` independent p-values (Šidák).
pub fn min_p_value(count: usize, p: f64) -> f64 {
    -(count as f64 * (-p.clamp(0.0, 1.0)).ln_1p()).exp_m1()
}

/// The combined p-value of independent p-values: the sum of the squares of their normal deviates follows χ². It detects
/// small errors everywhere.
pub fn combined_p_value(p_values: &[f64]) -> f64 {
    let Ok(chi_squared) = ChiSquared::new(p_values.len() as f64) else { return 1.0 };
    chi_squared.sf(p_values.iter().map(|&p| normal_deviate(p).powi(2)).sum())
}

/// The absolute normal deviate with this two-sided p-value. p-values below 1e-15 are clamped, so that it is finite.
pub fn normal_deviate(p: f64) -> f64 {
    Normal::new(0.0, 1.0).map_or(0.0, |normal| normal.inverse_cdf(1.0 - 0.5 * p.clamp(1e-15, 1.0)))
}
