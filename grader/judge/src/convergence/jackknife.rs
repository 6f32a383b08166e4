//! Intervals from independent blocks.

use statrs::distribution::{Binomial, ContinuousCDF, DiscreteCDF, StudentsT};

use verdict::convergence::Estimate;

/// Confidence of all intervals.
const CONFIDENCE: f64 = 0.95;

/// Estimates a smooth function of the means over `blocks` independent blocks, by the delete-one-block jackknife with
/// Student's t.
///
/// `statistic` gets the block to be left out, if any. It should be a logarithm where the quantity is a positive
/// average: then the interval is less lopsided. `None` with fewer than three blocks, or if the statistic is undefined.
pub(super) fn jackknife(blocks: usize, statistic: impl Fn(Option<usize>) -> Option<f64>) -> Option<Estimate> {
    let count = blocks as f64;
    let value = statistic(None).filter(|value| value.is_finite())?;
    let without: Vec<f64> = (0..blocks).map(|block| statistic(Some(block))).collect::<Option<_>>()?;
    let mean = without.iter().sum::<f64>() / count;
    let squares: f64 = without.iter().map(|other| (other - mean).powi(2)).sum();
    let standard_error = ((count - 1.0) / count * squares).sqrt();
    let degrees_of_freedom = count - 1.0;
    if degrees_of_freedom < 2.0 || !standard_error.is_finite() {
        return None;
    }
    let quantile = StudentsT::new(0.0, 1.0, degrees_of_freedom).ok()?.inverse_cdf(0.5 + 0.5 * CONFIDENCE);
    let margin = quantile * standard_error;
    Some(Estimate { value, interval: [value - margin, value + margin] })
}

/// The median with the interval between two order statistics that contains it with at least the wanted confidence,
/// whatever the distribution. With fewer than six values, the interval is their range. `None` without values.
pub(super) fn median(mut values: Vec<f64>) -> Option<Estimate> {
    values.sort_unstable_by(f64::total_cmp);
    let count = values.len();
    let value = 0.5 * (values.get(count.checked_sub(1)? / 2)? + values.get(count / 2)?);
    let below = Binomial::new(0.5, count as u64).ok()?;
    // The interval from the k-th smallest to the k-th largest value misses with probability 2 P(fewer than k below).
    let misses = |k: usize| 2.0 * below.cdf(k as u64 - 1);
    let rank = (1..=count / 2).take_while(|&k| misses(k) <= 1.0 - CONFIDENCE).last().unwrap_or(1);
    Some(Estimate { value, interval: [values[rank - 1], values[count - rank]] })
}
