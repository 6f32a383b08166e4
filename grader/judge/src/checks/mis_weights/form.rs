//! The functional form of the weights.

use verdict::check::WeightForm;

use super::{Configuration, Reading};
use crate::statistics::regression::{Fit, fit};

/// The form of a weight that should increase with p_L / p_B.
pub(super) fn of(seen: &[(Configuration, Reading)], weight: impl Fn(&Reading) -> f64) -> WeightForm {
    let values: Vec<f64> = seen.iter().map(|(_, seen)| weight(seen)).collect();
    let noise = seen.iter().map(|(_, seen)| seen.error).fold(0.0, f64::max);
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    if values.iter().all(|value| (value - mean).abs() < 1e-3 + 6.0 * noise) {
        return WeightForm::Constant(mean);
    }
    // Near 0 and 1 the logit is dominated by rounding and noise.
    let margin = 1e-4 + 10.0 * noise;
    let points: Vec<([f64; WeightForm::FACTORS], f64)> = seen
        .iter()
        .zip(&values)
        .filter(|(_, value)| (margin..1.0 - margin).contains(*value))
        .map(|((it, _), value)| {
            let logs =
                [it.p_light / it.p_bsdf, it.distance, it.cos_light, it.lights as f64, it.area].map(f64::ln);
            (logs, (value / (1.0 - value)).ln())
        })
        .collect();
    match fit(&points) {
        Some(Fit { slopes, residual, .. }) if residual < 0.15 => WeightForm::Powers(slopes),
        _ => WeightForm::Other,
    }
}
