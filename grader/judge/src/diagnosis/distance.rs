//! The distance between a report and a signature.
//!
//! In principle this is (y − m)ᵀ Σ⁻¹ (y − m), where y is the report and m the signature. Since checks observe the same
//! light along the same paths, their numbers are strongly correlated, and a student's code never equals a variant.
//! Hence each check counts once, with the number that differs most, in units of the standard errors and of a floor
//! ([`Quantity::scale`]) for the difference between programs with the same mistake; and no check contributes more than
//! [`MAX_CONTRIBUTION`].

use std::collections::{BTreeMap, BTreeSet};

use super::observation::{CheckObservations, CheckState, Number, ObservationVector};
use crate::checks::Quantity;

/// Maximum contribution of a single check: five standard deviations. No outlier decides alone.
pub(super) const MAX_CONTRIBUTION: f64 = 25.0;

/// Minimum contribution of a check that passes on one side only.
const MIN_FROM_PASS: f64 = 3.0;

/// Contribution of a check that passes on one side only, if the size of the error is unknown.
const UNKNOWN_FROM_PASS: f64 = 14.0;

/// Minimum contribution of a check that fails on both sides for different reasons.
const DIFFERENT_FAILURE: f64 = 5.0;

/// Contribution of a check that timed out in the signature only. A timeout in the report only is not compared, since
/// machines differ.
const SIGNATURE_TIMEOUT: f64 = 6.0;

/// Contribution of each place that fails, if the check passes on the other side.
const PER_PLACE: f64 = 5.0;

/// Contribution of a check that fails at disjoint places.
const DISJOINT_PLACES: f64 = 6.0;

/// Contribution of a quantity that only one side has, such as the exponents of a weight.
const MISSING_QUANTITY: f64 = 9.0;

/// The distance of a report from a signature.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Distance {
    /// Sum of the contributions of all checks that both sides have.
    pub(super) squared: f64,
    /// Number of these checks that did not pass on both sides.
    pub(super) degrees_of_freedom: u32,
    /// Share of the report's failed checks that the signature has.
    pub(super) coverage: f64,
}

impl Distance {
    pub(super) fn between(seen: &ObservationVector, signature: &ObservationVector) -> Self {
        let mut distance = Self::default();
        let (mut wrong, mut compared) = (0, 0);
        for (check, a) in &seen.0 {
            wrong += u32::from(a.state != CheckState::Pass);
            let Some(b) = signature.0.get(check) else { continue };
            if a.state == CheckState::Pass && b.state == CheckState::Pass {
                continue;
            }
            let Some(contribution) = check_distance(a, b) else { continue };
            distance.squared += contribution;
            distance.degrees_of_freedom += 1;
            compared += u32::from(a.state != CheckState::Pass);
        }
        distance.coverage = f64::from(compared) / f64::from(wrong.max(1));
        distance
    }

    pub(super) fn plus(self, other: Self) -> Self {
        Self {
            squared: self.squared + other.squared,
            degrees_of_freedom: self.degrees_of_freedom + other.degrees_of_freedom,
            coverage: self.coverage.min(other.coverage),
        }
    }
}

/// Contribution of one check, where `a` is the report and `b` the signature; `None` if they cannot be compared.
pub(super) fn check_distance(a: &CheckObservations, b: &CheckObservations) -> Option<f64> {
    use CheckState::{Crash, Numerics, Pass, Timeout, Unclear, Wrong};
    let contribution = match (a.state, b.state) {
        (Pass, Pass) => 0.0,
        (Timeout, Timeout) | (Crash, Crash) => 0.0,
        (_, Timeout) => SIGNATURE_TIMEOUT,
        (Timeout, _) => return None,
        (Crash, _) | (_, Crash) => UNKNOWN_FROM_PASS,
        (Pass, Unclear) | (Unclear, Pass) => 1.0,
        (Pass, Wrong | Numerics) => distance_from_pass(b),
        (Wrong | Numerics, Pass) => distance_from_pass(a),
        // An inconclusive check may have the same error.
        (Unclear, Wrong | Numerics) | (Wrong | Numerics, Unclear) => {
            numbers_apart(&a.numbers, &b.numbers).max(1.0)
        }
        (Unclear, Unclear) => 0.0,
        (Wrong, Numerics) | (Numerics, Wrong) => numbers_apart(&a.numbers, &b.numbers).max(DIFFERENT_FAILURE),
        (Wrong, Wrong) | (Numerics, Numerics) => numbers_apart(&a.numbers, &b.numbers),
    };
    Some(contribution.min(MAX_CONTRIBUTION))
}

/// Contribution of a check that fails on one side and passes on the other.
fn distance_from_pass(wrong: &CheckObservations) -> f64 {
    let mean = wrong.numbers.iter().filter(|(quantity, _)| quantity.is_zero_if_right());
    let in_places = Some(places(&wrong.numbers).len()).filter(|&count| count > 0);
    let in_places = in_places.map(|count| (PER_PLACE * count as f64).min(UNKNOWN_FROM_PASS));
    let apart = mean.map(|(quantity, number)| squared(quantity, *number, Number(0.0, 0.0)));
    let furthest = apart.chain(in_places).reduce(f64::max);
    furthest.map_or(UNKNOWN_FROM_PASS, |furthest| furthest.max(MIN_FROM_PASS))
}

/// The places that fail, for checks with several scenes.
fn places(numbers: &BTreeMap<Quantity, Number>) -> BTreeSet<&Quantity> {
    numbers.keys().filter(|quantity| matches!(quantity, Quantity::WrongAt(_))).collect()
}

fn numbers_apart(a: &BTreeMap<Quantity, Number>, b: &BTreeMap<Quantity, Number>) -> f64 {
    let (places_of_a, places_of_b) = (places(a), places(b));
    let all = places_of_a.union(&places_of_b).count();
    let common = places_of_a.intersection(&places_of_b).count();
    let disjoint = if all == 0 { 0.0 } else { DISJOINT_PLACES * (1.0 - common as f64 / all as f64) };
    let quantities = a.keys().chain(b.keys().filter(|quantity| !a.contains_key(*quantity)));
    quantities
        .filter(|quantity| !matches!(quantity, Quantity::WrongAt(_)))
        .map(|quantity| match (a.get(quantity), b.get(quantity)) {
            (Some(a), Some(b)) => squared(quantity, *a, *b),
            // The quantity may be missing because it was too noisy.
            _ if quantity.may_be_missing() => 0.0,
            _ => MISSING_QUANTITY,
        })
        .fold(disjoint, f64::max)
}

/// Squared difference of two numbers in units of its variance.
fn squared(quantity: &Quantity, a: Number, b: Number) -> f64 {
    let floor = quantity.scale(0.5 * (a.0 + b.0));
    let variance = a.1.powi(2) + b.1.powi(2) + floor.powi(2);
    (a.0 - b.0).powi(2) / variance
}

#[cfg(test)]
mod tests {
    use verdict::check::CheckId;

    use super::*;
    use crate::checks::WrongPlace;

    fn seen(state: CheckState, numbers: &[(Quantity, f64)]) -> CheckObservations {
        let numbers =
            numbers.iter().map(|(quantity, value)| (quantity.clone(), Number(*value, 0.0))).collect();
        CheckObservations { state, numbers }
    }

    #[test]
    fn equal_factors_are_near_and_different_ones_far() {
        let factor = |factor: f64| seen(CheckState::Wrong, &[(Quantity::Mean, factor.ln())]);
        assert!(check_distance(&factor(2.0), &factor(2.05)).is_some_and(|it| it < 1.0));
        assert!(check_distance(&factor(2.0), &factor(3.0)).is_some_and(|it| it > 4.0));
        assert_eq!(check_distance(&factor(2.0), &factor(0.5)), Some(MAX_CONTRIBUTION));
    }

    #[test]
    fn a_small_error_is_near_a_pass() {
        let right = seen(CheckState::Pass, &[]);
        assert_eq!(
            check_distance(&right, &seen(CheckState::Wrong, &[(Quantity::Mean, 0.01)])),
            Some(MIN_FROM_PASS)
        );
        assert_eq!(
            check_distance(&right, &seen(CheckState::Wrong, &[(Quantity::Mean, 0.7)])),
            Some(MAX_CONTRIBUTION)
        );
        assert_eq!(check_distance(&seen(CheckState::Wrong, &[]), &right), Some(UNKNOWN_FROM_PASS));
    }

    #[test]
    fn timeouts_contribute_little() {
        let (late, wrong) = (seen(CheckState::Timeout, &[]), seen(CheckState::Wrong, &[]));
        assert_eq!((check_distance(&late, &wrong), check_distance(&late, &late)), (None, Some(0.0)));
        assert_eq!(check_distance(&wrong, &late), Some(SIGNATURE_TIMEOUT));
    }

    #[test]
    fn common_places_reduce_the_distance() {
        let at = |sizes: &[i32]| {
            let place = |&size: &i32| (Quantity::WrongAt(WrongPlace::Scaled(size)), 1.0);
            seen(CheckState::Wrong, &sizes.iter().map(place).collect::<Vec<_>>())
        };
        assert_eq!(check_distance(&at(&[1, 2]), &at(&[2, 1])), Some(0.0));
        assert_eq!(check_distance(&at(&[1, 2]), &at(&[2])), Some(DISJOINT_PLACES / 2.0));
        assert_eq!(check_distance(&at(&[1]), &at(&[2])), Some(DISJOINT_PLACES));
    }

    #[test]
    fn checks_of_one_side_only_are_ignored() {
        let vector = |ids: &[&str]| {
            let id =
                |scene: &str| format!("mean-bias/{scene}/nee/1").parse::<CheckId>().expect("it is a name");
            ObservationVector(
                ids.iter()
                    .map(|&scene| (id(scene), seen(CheckState::Wrong, &[(Quantity::Mean, 1.0)])))
                    .collect(),
            )
        };
        let distance = Distance::between(&vector(&["a", "b"]), &vector(&["b", "c"]));
        assert_eq!(distance, Distance { squared: 0.0, degrees_of_freedom: 1, coverage: 0.5 });
    }
}
