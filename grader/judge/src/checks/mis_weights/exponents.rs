//! What the weights depend on.

use super::{Configuration, Observation};
use crate::statistics::regression::{Fit, fit};

/// p_L / p_B, distance, cosine at the light, number of lights, 1 / density per area.
pub(super) const EXPONENTS: usize = 5;

/// The weights of one technique, as a function of the configuration.
#[derive(Clone, Copy, Debug)]
pub(super) enum Side {
    /// Always the same.
    Constant(f64),
    /// The odds are a product of powers.
    Powers([f64; EXPONENTS]),
    /// Anything else.
    Other,
}

impl Side {
    /// Finds the form of a weight that should rise with p_L / p_B.
    pub(super) fn of(seen: &[(&Configuration, Observation)], weight: impl Fn(&Observation) -> f64) -> Self {
        let values: Vec<f64> = seen.iter().map(|(_, seen)| weight(seen)).collect();
        let noise = seen.iter().map(|(_, seen)| seen.error).fold(0.0, f64::max);
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        if values.iter().all(|value| (value - mean).abs() < 1e-3 + 6.0 * noise) {
            return Self::Constant(mean);
        }
        // Near 0 and 1 the logit is all rounding or noise.
        let margin = 1e-4 + 10.0 * noise;
        let points: Vec<([f64; EXPONENTS], f64)> = seen
            .iter()
            .zip(&values)
            .filter(|(_, value)| (margin..1.0 - margin).contains(*value))
            .map(|((it, _), value)| {
                let logs = [it.p_light / it.p_bsdf, it.distance, it.cos_light, it.lights as f64, it.area]
                    .map(f64::ln);
                (logs, (value / (1.0 - value)).ln())
            })
            .collect();
        match fit(&points) {
            Some(Fit { slopes, residual, .. }) if residual < 0.15 => Self::Powers(slopes),
            _ => Self::Other,
        }
    }

    pub(super) fn exponents(&self) -> Option<[f64; EXPONENTS]> {
        match self {
            Self::Powers(powers) => Some(*powers),
            _ => None,
        }
    }

    /// Exponents that are whole numbers but for noise.
    fn whole(&self) -> Option<[i32; EXPONENTS]> {
        let powers = self.exponents()?;
        powers.iter().all(|it| (it - it.round()).abs() < 0.15).then(|| powers.map(|it| it.round() as i32))
    }
}

/// What is said of weights that pass.
pub(super) fn remark(light: &Side, deviation: f64) -> String {
    let kind = match light.whole() {
        Some([1, 0, 0, 0, 0]) => "the weights are those of the balance heuristic",
        Some([2, 0, 0, 0, 0]) => {
            "the weights are those of the power heuristic (exponent 2), which is right too; the sheet asks for the \
             balance heuristic"
        }
        _ => "the weights rise with the light's density, though they are not those of the balance heuristic",
    };
    format!("{kind}; they sum to one to within {deviation:.0e}")
}

/// What is said of weights that do not pass.
pub(super) fn explain(light: &Side, bsdf: &Side) -> String {
    match (light, bsdf) {
        (Side::Constant(light), Side::Constant(against)) => {
            let bsdf = 1.0 - against;
            match (*light, bsdf) {
                (l, b) if l.abs() < 1e-3 && (b - 1.0).abs() < 1e-3 => {
                    "light samples have no part in the picture: this is BSDF sampling".to_owned()
                }
                (l, b) if (l - 1.0).abs() < 1e-3 && b.abs() < 1e-3 => {
                    "lights that are hit have no part in the picture: this is next event estimation alone"
                        .to_owned()
                }
                (l, b) => format!(
                    "the weights are constant ({l:.2} for light samples, {b:.2} for BSDF samples) instead of \
                     depending on the densities"
                ),
            }
        }
        (Side::Powers(a), Side::Powers(b)) if a.iter().zip(b).all(|(a, b)| (a - b).abs() < 0.3) => {
            format!("in both weights, {}", fault(light).unwrap_or_else(|| unclear(light)))
        }
        _ => {
            let complaint = |name: &str, side: &Side| {
                fault(side).map(|fault| format!("in the weight of {name}, {fault}"))
            };
            let found: Vec<String> = [complaint("light samples", light), complaint("BSDF samples", bsdf)]
                .into_iter()
                .flatten()
                .collect();
            if found.is_empty() { "it could not be told why".to_owned() } else { found.join("; ") }
        }
    }
}

/// What is wrong on one side; `None` if nothing is.
fn fault(side: &Side) -> Option<String> {
    if let Side::Constant(value) = side {
        return Some(format!("the densities have no part (a constant, odds share {value:.2})"));
    }
    let Some([ratio, distance, cos, lights, area]) = side.whole() else { return Some(unclear(side)) };
    let mut faults = Vec::new();
    match ratio {
        1 | 2 => {}
        _ if ratio < 0 => {
            faults.push("the densities are swapped: the weight falls as its own density rises".to_owned())
        }
        _ => faults.push(format!("the ratio of the densities has the exponent {ratio}")),
    }
    let sign = if ratio < 0 { -1 } else { 1 };
    let (distance, cos, lights, area) = (sign * distance, sign * cos, sign * lights, sign * area);
    match (distance, cos) {
        (0, 0) => {}
        (..0, 1..) => faults.push(format!(
            "the density of the light is per area, not per solid angle: exponent {distance} on the distance, {cos} \
             on the cosine at the light"
        )),
        (distance, 0) => faults.push(format!("the distance has the exponent {distance} too much")),
        (0, cos) => faults.push(format!("the cosine at the light has the exponent {cos} too much")),
        (distance, cos) => faults.push(format!(
            "the change from area to solid angle is wrong: exponent {distance} too much on the distance, {cos} on the \
             cosine at the light"
        )),
    }
    match lights {
        0 => {}
        1.. => faults.push(format!(
            "the probability of picking the light is missing: exponent {lights} on the number of lights"
        )),
        _ => faults.push(format!(
            "the probability of picking the light counts twice: exponent {lights} on the number of lights"
        )),
    }
    if area != 0 {
        faults.push(format!("the density of the point on the light is missing: exponent {area} on its area"));
    }
    (!faults.is_empty()).then(|| faults.join(", and "))
}

fn unclear(side: &Side) -> String {
    match side {
        Side::Powers([ratio, distance, cos, lights, area]) => format!(
            "the exponents are {ratio:.2} on the ratio of the densities, {distance:.2} on the distance, {cos:.2} on \
             the cosine at the light, {lights:.2} on the number of lights, {area:.2} on the light's area; they should \
             be 1, 0, 0, 0, 0"
        ),
        _ => "the weight depends on the densities in no simple way".to_owned(),
    }
}
