//! Hypothesis tests with given false-alarm rates.

use statrs::distribution::{ChiSquared, ContinuousCDF, Normal, StudentsT};

/// Pearson's χ² test of counts against expected counts; returns the p-value.
///
/// Neighbouring categories are pooled until ten samples are expected in each; with fewer, the tail of the statistic is not
/// χ². Every sample is in a category.
pub(crate) fn chi_squared(observed: &[u64], expected: &[f64]) -> f64 {
    assert_eq!(observed.len(), expected.len());
    let mut pools: Vec<(f64, f64)> = Vec::new();
    let mut pool = (0.0, 0.0);
    for (&count, &mean) in observed.iter().zip(expected) {
        assert!(mean.is_finite() && mean > -1.0, "an expected count of {mean}");
        pool.0 += count as f64;
        pool.1 += mean.max(0.0);
        if pool.1 >= 10.0 {
            pools.push(std::mem::take(&mut pool));
        }
    }
    let last = pools.last_mut().expect("more than ten samples");
    last.0 += pool.0;
    last.1 += pool.1;
    assert!(pools.len() > 1, "one category cannot disagree");
    let statistic: f64 = pools.iter().map(|(count, mean)| (count - mean).powi(2) / mean).sum();
    ChiSquared::new((pools.len() - 1) as f64).expect("at least one degree of freedom").sf(statistic)
}

/// Counts samples of the unit square in a grid of `size × size` cells.
pub(crate) fn grid_counts(size: usize, points: impl Iterator<Item = (f64, f64)>) -> Vec<u64> {
    let mut counts = vec![0; size * size];
    let cell = |value: f64| ((value * size as f64) as usize).min(size - 1);
    for (u, v) in points {
        assert!((-1e-6..=1.0 + 1e-6).contains(&u) && (-1e-6..=1.0 + 1e-6).contains(&v), "({u}, {v})");
        counts[cell(v) * size + cell(u)] += 1;
    }
    counts
}

/// The p-value of the hypothesis that points are uniform in the unit square, by χ² over a grid.
pub(crate) fn uniformity(size: usize, points: impl Iterator<Item = (f64, f64)>) -> f64 {
    let counts = grid_counts(size, points);
    let total: u64 = counts.iter().sum();
    chi_squared(&counts, &vec![total as f64 / counts.len() as f64; counts.len()])
}

/// The mean of some numbers, and its standard error.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Estimate {
    pub(crate) mean: f64,
    pub(crate) standard_error: f64,
    count: usize,
}

impl Estimate {
    pub(crate) fn of(values: impl IntoIterator<Item = f64>) -> Self {
        let (mut count, mut mean, mut squares) = (0, 0.0, 0.0);
        for value in values {
            count += 1;
            let difference = value - mean;
            mean += difference / count as f64;
            squares += difference * (value - mean);
        }
        let variance: f64 = squares / (count as f64 - 1.0);
        Self { mean, standard_error: (variance / count as f64).sqrt(), count }
    }

    /// Half the width of the interval that misses the true mean with probability `alpha` (Student's t).
    pub(crate) fn margin(&self, alpha: f64) -> f64 {
        let student = StudentsT::new(0.0, 1.0, self.count as f64 - 1.0).expect("at least two numbers");
        self.standard_error * student.inverse_cdf(1.0 - alpha / 2.0)
    }

    /// Asserts that the true mean is `exact`, up to the relative rounding error `rounding`.
    ///
    /// A correct estimator fails with probability `alpha`. To make sure that a wrong one fails, the test also asserts that it
    /// would detect a relative bias of `resolution` with a probability of one half.
    pub(crate) fn assert_is(&self, exact: f64, rounding: f64, resolution: f64, alpha: f64, what: &str) {
        let allowed = self.margin(alpha) + rounding * exact;
        assert!((self.mean - exact).abs() <= allowed, "{what}: {} ± {allowed}, expected {exact}", self.mean);
        assert!(allowed <= resolution * exact, "{what}: sees only biases from {}", allowed / exact);
    }

    /// True if `exact` is outside the interval of [`assert_is`](Self::assert_is), for tests of the test.
    pub(crate) fn rejects(&self, exact: f64, alpha: f64) -> bool {
        (self.mean - exact).abs() > self.margin(alpha)
    }
}

/// The p-value of the hypothesis that an event of the given probability occurred `count` times in `total`.
pub(crate) fn share(count: u64, total: u64, probability: f64) -> f64 {
    let (count, total) = (count as f64, total as f64);
    let deviation = (total * probability * (1.0 - probability)).sqrt();
    if deviation == 0.0 {
        return if count == total * probability { 1.0 } else { 0.0 };
    }
    // Continuity correction.
    let z = ((count - total * probability).abs() - 0.5).max(0.0) / deviation;
    2.0 * Normal::standard().sf(z)
}
