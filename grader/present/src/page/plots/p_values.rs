//! p-values of all tiles of all pictures that were judged.

use statrs::function::erf::erfc;

use super::{Bars, bars};
use verdict::check::{CheckResult, Verdict};

/// Bars between 0 and 1.
const COUNT: usize = 20;

/// A histogram of p-values.
pub(crate) struct PValues {
    /// The plot.
    pub(crate) plot: String,
    /// Number of tiles.
    pub(crate) tiles: usize,
    /// Number of pictures that they are from.
    pub(crate) pictures: usize,
    /// Share of them in the first bar: p < 0.05.
    pub(crate) unlikely: f64,
}

/// The histogram of the checks' kept normal deviates, of checks that passed (`passed`) or of the others; `None` without
/// any. Tiles in which nothing varies and nothing differs have no p-value.
pub(crate) fn p_values(checks: &[CheckResult], passed: bool) -> Option<PValues> {
    let of_verdict = checks.iter().filter(|check| (check.verdict == Verdict::Pass) == passed);
    let deviates = of_verdict.filter_map(|check| Some(check.mean_test()?.z.as_slice()));
    let chosen: Vec<&[f64]> = deviates.filter(|z| z.iter().any(|&z| z != 0.0)).collect();
    let mut counts = [0; COUNT];
    for z in chosen.iter().copied().flatten().filter(|z| **z != 0.0 && z.is_finite()) {
        let p = erfc(z.abs() / std::f64::consts::SQRT_2);
        counts[((p * COUNT as f64) as usize).min(COUNT - 1)] += 1;
    }
    let tiles: usize = counts.iter().sum();
    let mean = tiles as f64 / COUNT as f64;
    // A binomial count is nearly normal; 95 % of a normal variable lie within 1.96 standard deviations.
    let margin = 1.96 * (mean * (1.0 - 1.0 / COUNT as f64)).sqrt();
    let plot = bars(&Bars {
        label: "histogram of p-values",
        axis: "p-value of a tile's difference from the reference",
        range: (0.0, 1.0),
        counts: &counts,
        expected: Some((mean, [(mean - margin).max(0.0), mean + margin])),
    })?;
    Some(PValues { plot, tiles, pictures: chosen.len(), unlikely: counts[0] as f64 / tiles as f64 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use verdict::check::{Evidence, MeanTest};
    use verdict::sample::{mean_test, report};

    #[test]
    fn deviates_of_no_bias_are_spread_evenly_and_others_are_not() {
        let mut check = report("open").checks.remove(0);
        check.verdict = Verdict::Pass;
        // z whose p-values are 0.025, 0.075, … by their quantiles.
        use statrs::distribution::{ContinuousCDF, Normal};
        let normal = Normal::standard();
        let with = |check: &mut CheckResult, z| {
            check.evidence = Some(Evidence::MeanBias(MeanTest { z, ..mean_test() }));
        };
        let mut z: Vec<f64> = (0..40).map(|i| normal.inverse_cdf((f64::from(i) + 0.5) / 40.0)).collect();
        with(&mut check, z.clone());
        let even = p_values(&[check.clone()], true).expect("there are some");
        assert_eq!((even.tiles, even.pictures), (40, 1));
        assert!((even.unlikely - 0.05).abs() < 1e-9, "{}", even.unlikely);
        z.iter_mut().for_each(|z| *z += 4.0);
        with(&mut check, z);
        assert!(p_values(&[check.clone()], true).expect("there are some").unlikely > 0.8);
        with(&mut check, vec![0.0; 64]);
        assert!(p_values(&[check], true).is_none(), "nothing varies");
    }
}
