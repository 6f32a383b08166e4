//! How far two observations are apart.
//!
//! In principle this is (y − m)ᵀ Σ⁻¹ (y − m) with y what was seen and m the signature. Checks see the same light along
//! the same paths, so that their numbers are anything but independent; and a student's code is never quite the variant's.
//! So each check counts once, with the one number that differs most, in units of the measured standard errors and of
//! a floor ([`Quantity::scale`]) that stands for how much two programs with the same mistake may differ; and no check counts
//! more than [`MOST_OF_ONE`].

use std::collections::{BTreeMap, BTreeSet};

use super::observation::{Number, Seen, State, Vector};
use crate::checks::Quantity;

/// What a single check can contribute at most: five standard deviations. A check that went astray decides nothing alone.
pub(super) const MOST_OF_ONE: f64 = 25.0;

/// What it contributes if one side passes where the other is wrong by too little to be sure of.
const BARELY: f64 = 3.0;

/// The same where nothing says by how much it is wrong.
const PLAINLY: f64 = 14.0;

/// If both are wrong, but not in the same way.
const ANOTHER_WAY: f64 = 5.0;

/// If the signature ran out of time, and what was seen did not. The other way round nothing is compared: machines differ.
const LATE: f64 = 6.0;

/// For each scene or change of a scene in which something is wrong, where the other side passes.
const EACH_PLACE: f64 = 5.0;

/// If what is wrong is wrong in places that have nothing in common.
const OTHER_PLACES: f64 = 6.0;

/// If a number is there on one side only, as exponents are for weights that have a form.
const ANOTHER_FORM: f64 = 9.0;

/// How far a report is from a signature.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Distance {
    /// The sum over all checks that both have.
    pub(super) squared: f64,
    /// How many of these did not pass on both sides.
    pub(super) freedom: u32,
    /// Of the checks that are wrong in what was seen, the share that the signature has something to say about.
    pub(super) covered: f64,
}

impl Distance {
    pub(super) fn between(seen: &Vector, signature: &Vector) -> Self {
        let mut distance = Self::default();
        let (mut wrong, mut compared) = (0, 0);
        for (check, a) in &seen.0 {
            wrong += u32::from(a.state != State::Pass);
            let Some(b) = signature.0.get(check) else { continue };
            if a.state == State::Pass && b.state == State::Pass {
                continue;
            }
            let Some(contribution) = of_check(a, b) else { continue };
            distance.squared += contribution;
            distance.freedom += 1;
            compared += u32::from(a.state != State::Pass);
        }
        distance.covered = f64::from(compared) / f64::from(wrong.max(1));
        distance
    }

    pub(super) fn plus(self, other: Self) -> Self {
        Self {
            squared: self.squared + other.squared,
            freedom: self.freedom + other.freedom,
            covered: self.covered.min(other.covered),
        }
    }
}

/// What one check contributes, `a` being what was seen and `b` the signature; none if they cannot be compared.
pub(super) fn of_check(a: &Seen, b: &Seen) -> Option<f64> {
    use State::{Crash, Numerics, Pass, Timeout, Unclear, Wrong};
    let contribution = match (a.state, b.state) {
        (Pass, Pass) => 0.0,
        (Timeout, Timeout) | (Crash, Crash) => 0.0,
        (_, Timeout) => LATE,
        (Timeout, _) => return None,
        (Crash, _) | (_, Crash) => PLAINLY,
        (Pass, Unclear) | (Unclear, Pass) => 1.0,
        (Pass, Wrong | Numerics) => from_right(b),
        (Wrong | Numerics, Pass) => from_right(a),
        // Whoever could not tell may have seen the same.
        (Unclear, Wrong | Numerics) | (Wrong | Numerics, Unclear) => {
            numbers_apart(&a.numbers, &b.numbers).max(1.0)
        }
        (Unclear, Unclear) => 0.0,
        (Wrong, Numerics) | (Numerics, Wrong) => numbers_apart(&a.numbers, &b.numbers).max(ANOTHER_WAY),
        (Wrong, Wrong) | (Numerics, Numerics) => numbers_apart(&a.numbers, &b.numbers),
    };
    Some(contribution.min(MOST_OF_ONE))
}

/// How far a check that is wrong is from one that passes.
fn from_right(wrong: &Seen) -> f64 {
    let mean = wrong.numbers.iter().filter(|(quantity, _)| quantity.is_zero_if_right());
    let in_places = Some(places(&wrong.numbers).len()).filter(|&count| count > 0);
    let in_places = in_places.map(|count| (EACH_PLACE * count as f64).min(PLAINLY));
    let apart = mean.map(|(quantity, number)| squared(quantity, *number, Number(0.0, 0.0)));
    let furthest = apart.chain(in_places).reduce(f64::max);
    furthest.map_or(PLAINLY, |furthest| furthest.max(BARELY))
}

/// Where something is wrong, for checks that look at several scenes.
fn places(numbers: &BTreeMap<Quantity, Number>) -> BTreeSet<&Quantity> {
    numbers.keys().filter(|quantity| matches!(quantity, Quantity::WrongAt(_))).collect()
}

fn numbers_apart(a: &BTreeMap<Quantity, Number>, b: &BTreeMap<Quantity, Number>) -> f64 {
    let (places_of_a, places_of_b) = (places(a), places(b));
    let all = places_of_a.union(&places_of_b).count();
    let common = places_of_a.intersection(&places_of_b).count();
    let elsewhere = if all == 0 { 0.0 } else { OTHER_PLACES * (1.0 - common as f64 / all as f64) };
    let quantities = a.keys().chain(b.keys().filter(|quantity| !a.contains_key(*quantity)));
    quantities
        .filter(|quantity| !matches!(quantity, Quantity::WrongAt(_)))
        .map(|quantity| match (a.get(quantity), b.get(quantity)) {
            (Some(a), Some(b)) => squared(quantity, *a, *b),
            // A mean that is missing is one that could not be told.
            _ if quantity.may_be_missing() => 0.0,
            _ => ANOTHER_FORM,
        })
        .fold(elsewhere, f64::max)
}

/// The difference of two numbers, squared, in units of what it may be.
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

    fn seen(state: State, numbers: &[(Quantity, f64)]) -> Seen {
        let numbers =
            numbers.iter().map(|(quantity, value)| (quantity.clone(), Number(*value, 0.0))).collect();
        Seen { state, numbers }
    }

    #[test]
    fn the_same_factor_is_near_and_another_is_far() {
        let factor = |factor: f64| seen(State::Wrong, &[(Quantity::Mean, factor.ln())]);
        assert!(of_check(&factor(2.0), &factor(2.05)).is_some_and(|it| it < 1.0));
        assert!(of_check(&factor(2.0), &factor(3.0)).is_some_and(|it| it > 4.0));
        assert_eq!(of_check(&factor(2.0), &factor(0.5)), Some(MOST_OF_ONE));
    }

    #[test]
    fn an_error_that_is_barely_seen_is_barely_apart_from_none() {
        let right = seen(State::Pass, &[]);
        assert_eq!(of_check(&right, &seen(State::Wrong, &[(Quantity::Mean, 0.01)])), Some(BARELY));
        assert_eq!(of_check(&right, &seen(State::Wrong, &[(Quantity::Mean, 0.7)])), Some(MOST_OF_ONE));
        assert_eq!(of_check(&seen(State::Wrong, &[]), &right), Some(PLAINLY));
    }

    #[test]
    fn time_that_ran_out_says_little() {
        let (late, wrong) = (seen(State::Timeout, &[]), seen(State::Wrong, &[]));
        assert_eq!((of_check(&late, &wrong), of_check(&late, &late)), (None, Some(0.0)));
        assert_eq!(of_check(&wrong, &late), Some(LATE));
    }

    #[test]
    fn places_in_common_bring_two_nearer() {
        let at = |sizes: &[i32]| {
            let place = |&size: &i32| (Quantity::WrongAt(WrongPlace::Scaled(size)), 1.0);
            seen(State::Wrong, &sizes.iter().map(place).collect::<Vec<_>>())
        };
        assert_eq!(of_check(&at(&[1, 2]), &at(&[2, 1])), Some(0.0));
        assert_eq!(of_check(&at(&[1, 2]), &at(&[2])), Some(OTHER_PLACES / 2.0));
        assert_eq!(of_check(&at(&[1]), &at(&[2])), Some(OTHER_PLACES));
    }

    #[test]
    fn what_only_one_side_has_seen_does_not_count() {
        let vector = |ids: &[&str]| {
            let id =
                |scene: &str| format!("mean-bias/{scene}/nee/1").parse::<CheckId>().expect("it is a name");
            Vector(
                ids.iter().map(|&scene| (id(scene), seen(State::Wrong, &[(Quantity::Mean, 1.0)]))).collect(),
            )
        };
        let distance = Distance::between(&vector(&["a", "b"]), &vector(&["b", "c"]));
        assert_eq!(distance, Distance { squared: 0.0, freedom: 1, covered: 0.5 });
    }
}
