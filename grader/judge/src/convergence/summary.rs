//! Summary numbers of a curve.

use super::estimate::{PointEstimate, with_percentiles};
use crate::statistics::regression::fit;
use verdict::convergence::{Estimate, Point};

/// The slope of ln(relative MSE) over ln(seconds). Points with a negative error, which is pure noise, are ignored.
/// `None` with fewer than four usable points.
pub(super) fn slope(levels: &[PointEstimate]) -> Option<Estimate> {
    let of = |error: &dyn Fn(&PointEstimate) -> f64| -> Option<f64> {
        let usable = levels.iter().map(|level| (level.point.seconds, error(level)));
        let points: Vec<([f64; 1], f64)> = usable
            .filter(|&(seconds, error)| seconds > 0.0 && error > 0.0)
            .map(|(seconds, error)| ([seconds.ln()], error.ln()))
            .collect();
        Some(fit(&points)?.slopes[0])
    };
    let value = of(&|level| level.point.relative_mse.value)?;
    Some(with_percentiles(value, replicated(levels, |index| of(&|level| level.replicates[index]))))
}

/// Efficiency relative to the solution: the ratio of 1/(relative MSE × seconds), as the geometric mean over the longer
/// half of the renderings.
pub(super) fn efficiency(levels: &[PointEstimate], solution: &[PointEstimate]) -> Option<Estimate> {
    let log_cost = |levels: &[PointEstimate], error: &dyn Fn(&PointEstimate) -> f64| -> Option<f64> {
        let longer = &levels[levels.len() / 2..];
        let costs: Vec<f64> = longer
            .iter()
            .map(|level| error(level) * level.point.seconds)
            .filter(|&cost| cost > 0.0)
            .collect();
        (!costs.is_empty()).then(|| costs.iter().map(|cost| cost.ln()).sum::<f64>() / costs.len() as f64)
    };
    let of = |error: &dyn Fn(&PointEstimate) -> f64| -> Option<f64> {
        Some((log_cost(solution, error)? - log_cost(levels, error)?).exp())
    };
    let value = of(&|level| level.point.relative_mse.value)?;
    Some(with_percentiles(value, replicated(levels, |index| of(&|level| level.replicates[index]))))
}

fn replicated(levels: &[PointEstimate], of: impl Fn(usize) -> Option<f64>) -> Vec<f64> {
    let count = levels.first().map_or(0, |level| level.replicates.len());
    (0..count).filter_map(of).collect()
}

/// The time to reach a relative MSE of `target`, by log–log interpolation between two points, or by a slope of −1
/// before the first. `None` if even the longest renderings have a larger error.
pub(super) fn seconds_to(target: f64, points: &[Point]) -> Option<f64> {
    let reached = points.iter().position(|point| point.relative_mse.value <= target)?;
    let (after, error) = (points[reached].seconds, points[reached].relative_mse.value.max(f64::MIN_POSITIVE));
    let Some(before) = reached.checked_sub(1).map(|index| &points[index]) else {
        return Some(after * error / target);
    };
    let share = (before.relative_mse.value / target).ln() / (before.relative_mse.value / error).ln();
    Some((before.seconds.ln() + share * (after / before.seconds).ln()).exp())
}

/// Rounds to one significant digit, for a readable target.
pub(super) fn rounded(value: f64) -> f64 {
    let unit = 10.0_f64.powf(value.log10().floor());
    if unit > 0.0 && unit.is_finite() { (value / unit).round() * unit } else { value }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(error: fn(f64) -> f64) -> Vec<PointEstimate> {
        let level = |k: i32| {
            let seconds = 0.01 * 4.0_f64.powi(k);
            let value = error(seconds);
            let exact = Estimate { value, interval: [value; 2] };
            let point = Point {
                samples: 1,
                renders: 2,
                seconds,
                relative_mse: exact,
                trimmed_relative_mse: exact,
                mse: exact,
                bias_squared: exact,
                variance: exact,
            };
            PointEstimate { point, replicates: vec![value; 3] }
        };
        (0..6).map(level).collect()
    }

    fn points(levels: &[PointEstimate]) -> Vec<Point> {
        levels.iter().map(|level| level.point.clone()).collect()
    }

    #[test]
    fn an_unbiased_curve_has_slope_minus_one_and_a_biased_one_flattens() {
        let slope_of = |error| slope(&curve(error)).expect("six points").value;
        assert!((slope_of(|seconds| 0.02 / seconds) + 1.0).abs() < 1e-9);
        assert!(slope_of(|seconds| 0.02 / seconds + 0.1) > -0.8);
        assert!(slope(&curve(|_| -1.0)).is_none(), "no error can be drawn");
    }

    #[test]
    fn a_program_with_twice_the_error_is_half_as_efficient() {
        let (good, bad) = (curve(|seconds| 0.02 / seconds), curve(|seconds| 0.04 / seconds));
        assert!((efficiency(&bad, &good).expect("both have errors").value - 0.5).abs() < 1e-9);
    }

    #[test]
    fn the_time_to_a_target_is_interpolated() {
        let points = points(&curve(|seconds| 0.02 / seconds));
        for target in [3.0, 1.0, 0.02] {
            let seconds = seconds_to(target, &points).expect("it gets there");
            assert!((seconds - 0.02 / target).abs() < 1e-9, "{target}: {seconds}");
        }
        assert_eq!(seconds_to(1e-6, &points), None);
        assert_eq!((rounded(0.0123), rounded(0.0), rounded(38.0)), (0.01, 0.0, 40.0));
    }
}
