//! MIS weights.

use verdict::check::{MeasuredWeights, OnlyWay, WeightFault, WeightForm, WeightTest};

use super::number::{power, significant, trimmed};

/// Deviations of a sum from one up to this are rounding.
const ROUNDING: f64 = 1e-4;

/// How close a constant weight is to 0 or 1 to be that.
const EXACT: f64 = 1e-3;

/// What is wrong with the weights, or which heuristic they are.
pub(super) fn weights(test: &WeightTest) -> String {
    let measured = test.measured.as_ref();
    match test.fault {
        None => measured.map_or_else(|| "the weights are correct".to_owned(), right),
        Some(WeightFault::NotANumber { light, bsdf }) => format!(
            "a path returns NaN or infinity where the density per solid angle is {light:.1e} for the light sample and \
             {bsdf:.1e} for the BSDF sample"
        ),
        Some(WeightFault::LaterVertices) => {
            "the weights are correct at the first vertex of a path and wrong at later ones: \
            the density that you remember is not that of the last bounce"
                .to_owned()
        }
        Some(WeightFault::OnlyWay(light)) => only_way(light, measured),
        Some(WeightFault::FirstVertex) => {
            measured.map_or_else(|| "the weights are wrong".to_owned(), first_vertex)
        }
    }
}

fn right(measured: &MeasuredWeights) -> String {
    let kind = match measured.light.whole_exponents() {
        Some([1, 0, 0, 0, 0]) => "balance heuristic",
        Some([2, 0, 0, 0, 0]) => {
            "power heuristic with exponent 2, which is correct, too (the sheet asks for the balance heuristic)"
        }
        _ => {
            "the weights rise with the density of the light sample, but are not those of the balance heuristic"
        }
    };
    format!("{kind}; the weights sum to 1 to within {:.0e}", measured.largest_deviation())
}

fn only_way(light: OnlyWay, measured: Option<&MeasuredWeights>) -> String {
    let name = match light {
        OnlyWay::SeenByCamera => "a light that the camera sees",
        OnlyWay::AfterDelta => "a light that is hit after a delta bounce",
        OnlyWay::PointLight => "a point light",
        OnlyWay::AfterLight => "a light that is hit after another light and a delta bounce",
    };
    let weight = measured.and_then(|measured| measured.only_way.iter().find(|other| other.light == light));
    match weight.map(|weight| weight.weight) {
        Some(Some(weight)) => {
            format!("{name} has weight {} instead of 1: only one technique can find it", trimmed(weight, 3))
        }
        Some(None) => format!("{name} returns NaN or infinity"),
        None => format!("{name} does not have weight 1: only one technique can find it"),
    }
}

fn first_vertex(measured: &MeasuredWeights) -> String {
    let why = why(measured.light, measured.bsdf);
    let [min, max] = measured.sum.map(|sum| trimmed(sum, 3));
    if measured.deviation_at_first_vertex < ROUNDING {
        why
    } else if min == max {
        format!("the two weights of a path sum to {min} instead of 1; {why}")
    } else {
        format!("the two weights of a path sum to between {min} and {max} instead of 1; {why}")
    }
}

/// What the forms of the weights say. `bsdf` is that of one minus the weight of a BSDF sample.
fn why(light: WeightForm, bsdf: WeightForm) -> String {
    match (light, bsdf) {
        (WeightForm::Constant(light), WeightForm::Constant(against)) => constant(light, 1.0 - against),
        (WeightForm::Powers(a), WeightForm::Powers(b))
            if a.iter().zip(b).all(|(a, b)| (a - b).abs() < 0.3) =>
        {
            format!("in both weights, {}", fault(light).unwrap_or_else(|| unclear(light)))
        }
        (WeightForm::Other, WeightForm::Other) => {
            "neither weight is a simple function of the densities".to_owned()
        }
        _ => {
            let of = |name: &str, form| match form {
                WeightForm::Other => {
                    Some(format!("the weight of {name} is not a simple function of the densities"))
                }
                _ => fault(form).map(|fault| format!("in the weight of {name}, {fault}")),
            };
            let found = [of("light samples", light), of("BSDF samples", bsdf)];
            let found: Vec<String> = found.into_iter().flatten().collect();
            if found.is_empty() { "the reason is unknown".to_owned() } else { found.join("; ") }
        }
    }
}

fn constant(light: f64, bsdf: f64) -> String {
    let is = |weight: f64, value: f64| (weight - value).abs() < EXACT;
    if is(light, 0.0) && is(bsdf, 1.0) {
        "light samples have weight 0: this is BSDF sampling alone".to_owned()
    } else if is(light, 1.0) && is(bsdf, 0.0) {
        "lights that are hit have weight 0: this is next event estimation alone".to_owned()
    } else {
        format!(
            "the weights ignore the densities: they are always {} for light samples and {} for BSDF samples",
            trimmed(light, 2),
            trimmed(bsdf, 2)
        )
    }
}

/// What is wrong with one weight; none if nothing is.
fn fault(form: WeightForm) -> Option<String> {
    if let WeightForm::Constant(_) = form {
        return Some("the densities are ignored: the weight is constant".to_owned());
    }
    let Some([ratio, distance, cos, lights, area]) = form.whole_exponents() else {
        return Some(unclear(form));
    };
    let mut faults = Vec::new();
    match ratio {
        1 | 2 => {}
        _ if ratio < 0 => {
            faults.push("the densities are swapped: the weight falls as its own density rises".to_owned());
        }
        0 => faults.push("the densities are ignored".to_owned()),
        _ => faults.push(format!("the density ratio has the exponent {ratio} instead of 1")),
    }
    let sign = if ratio < 0 { -1 } else { 1 };
    let [distance, cos, lights, area] = [distance, cos, lights, area].map(|exponent| sign * exponent);
    let (of_distance, of_cos) = (power("distance", distance), power("cos θ", cos));
    match (distance, cos) {
        (0, 0) => {}
        (..0, 1..) => faults.push(format!(
            "the density of the light is per area, not per solid angle (spurious factors {of_distance} and {of_cos})"
        )),
        (_, 0) => faults.push(format!("there is a spurious factor {of_distance}")),
        (0, _) => faults.push(format!("there is a spurious factor {of_cos}, θ being the angle at the light")),
        _ => faults.push(format!(
            "the conversion from area to solid angle is wrong (spurious factors {of_distance} and {of_cos})"
        )),
    }
    let of_lights = power("n", lights.abs());
    match lights {
        0 => {}
        1.. => faults.push(format!(
            "the density of the light lacks the selection probability (spurious factor {of_lights} for n lights)"
        )),
        _ => faults.push(format!(
            "the density of the light has the selection probability twice (spurious factor 1/{of_lights} for n lights)"
        )),
    }
    if area != 0 {
        faults.push(format!(
            "the density of the point on the light is missing (spurious factor {})",
            power("area", area)
        ));
    }
    (!faults.is_empty()).then(|| faults.join(", and "))
}

fn unclear(form: WeightForm) -> String {
    match form {
        WeightForm::Powers(exponents) => {
            let [ratio, distance, cos, lights, area] = exponents.map(significant);
            format!(
                "the exponents are {ratio} for the density ratio, {distance} for the distance, {cos} for the cosine at \
                 the light, {lights} for the number of lights and {area} for the area of the light instead of 1, 0, 0, \
                 0, 0"
            )
        }
        WeightForm::Constant(_) | WeightForm::Other => {
            "the dependence on the densities has no simple form".to_owned()
        }
    }
}
