//! Curves and panels from what was measured.

use arty::integrator::Technique;

use super::tally::Tally;
use crate::image_error::relative_weight;
use crate::reference::ReferenceView;
use verdict::convergence::{Bias, Curve, Estimate, Panel, Role};

/// A measured curve, without what is relative to others.
pub(super) struct MeasuredCurve {
    pub(super) curve: Curve,
    pub(super) tally: Tally,
}

impl MeasuredCurve {
    /// A curve of what was measured.
    pub(super) fn new(
        name: String,
        (role, technique): (Role, Technique),
        tally: Tally,
        bias: Bias,
        non_finite: u64,
    ) -> Self {
        let heavy_tailed = tally.is_heavy_tailed();
        let mut points = tally.points();
        if heavy_tailed {
            for point in &mut points {
                point.relative_mse = Estimate::without_interval(point.relative_mse.value);
                point.mse = point.mse.map(|mse| Estimate::without_interval(mse.value));
            }
        }
        let curve = Curve {
            name,
            role,
            technique,
            points,
            slope: tally.slope(),
            efficiency: None,
            relative_cost: None,
            seconds_to_target: None,
            cost: tally.cost(),
            bias,
            heavy_tailed,
            non_finite,
        };
        Self { curve, tally }
    }
}

/// The panel of one scene and technique.
pub(super) fn panel(
    scene: String,
    (technique, max_bounces): (Technique, u32),
    view: &ReferenceView,
    target: Option<f64>,
    measured: &[MeasuredCurve],
) -> Panel {
    let belongs = |measured: &&MeasuredCurve| {
        measured.curve.technique == technique || measured.curve.role == Role::Baseline
    };
    let shown: Vec<&MeasuredCurve> = measured.iter().filter(belongs).collect();
    let of_role = |role| shown.iter().find(|measured| measured.curve.role == role).copied();
    let yardstick = of_role(Role::Rival).or(of_role(Role::Solution));
    let middle = yardstick.or(shown.first().copied()).map_or(0.0, |measured| {
        let points = &measured.curve.points;
        points.get(points.len() / 2).map_or(0.0, |point| point.relative_mse.value)
    });
    let target = target.unwrap_or_else(|| rounded(middle));
    let curve = |measured: &&MeasuredCurve| Curve {
        efficiency: yardstick.and_then(|yardstick| measured.tally.efficiency(&yardstick.tally)),
        relative_cost: yardstick.and_then(|yardstick| measured.tally.relative_cost(&yardstick.tally)),
        // A biased curve flattens, so that the line through it says nothing.
        seconds_to_target: match measured.curve.bias {
            Bias::Found { .. } => None,
            _ if measured.curve.heavy_tailed => {
                measured.tally.seconds_to(target).map(|seconds| Estimate::without_interval(seconds.value))
            }
            _ => measured.tally.seconds_to(target),
        },
        ..measured.curve.clone()
    };
    let ReferenceView { mean, variance_of_mean, .. } = view;
    let noise = mean.iter().flatten().zip(variance_of_mean.iter().flatten());
    let noise = noise.map(|(&mean, variance)| relative_weight(mean) * variance).sum::<f64>();
    Panel {
        scene,
        technique,
        max_bounces,
        target,
        reference_noise: noise / (3 * mean.len()).max(1) as f64,
        yardstick: yardstick.map(|measured| measured.curve.name.clone()),
        curves: shown.iter().map(curve).collect(),
    }
}

/// Rounds to one significant digit, for a readable target.
fn rounded(value: f64) -> f64 {
    let unit = 10.0_f64.powf(value.log10().floor());
    if unit > 0.0 && unit.is_finite() { (value / unit).round() * unit } else { value }
}

#[cfg(test)]
mod tests {
    use super::rounded;

    #[test]
    fn targets_have_one_digit() {
        assert_eq!((rounded(0.0123), rounded(0.0), rounded(38.0)), (0.01, 0.0, 40.0));
    }
}
