//! How far two observations are apart.
//!
//! In principle this is (y − m)ᵀ Σ⁻¹ (y − m) with y what was seen and m the signature. Checks see the same light along
//! the same paths, so that their numbers are anything but independent; and a student's code is never quite the variant's.
//! So each check counts once, with the one number that differs most, in units of the measured standard errors and of
//! a floor ([`scale`]) that stands for how much two programs with the same mistake may differ; and no check counts
//! more than [`MOST_OF_ONE`].

use std::collections::BTreeMap;

use super::observation::{Number, Seen, State, Vector};

/// What a single check can contribute at most: five standard deviations. A check that went astray decides nothing alone.
pub(super) const MOST_OF_ONE: f64 = 25.0;

/// What it contributes if one side passes where the other is wrong by too little to be sure of.
const BARELY: f64 = 3.0;

/// The same where nothing says by how much it is wrong.
const PLAINLY: f64 = 14.0;

/// If both are wrong, but not in the same way.
const ANOTHER_WAY: f64 = 5.0;

/// If one side ran out of time: machines differ.
const LATE: f64 = 2.0;

/// If a number is there on one side only, as exponents are for weights that have a form.
const ANOTHER_FORM: f64 = 9.0;

/// How far a report is from a signature.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Distance {
    /// The sum over all checks that both have.
    pub(super) squared: f64,
    /// How many of these did not pass on both sides.
    pub(super) freedom: u32,
}

impl Distance {
    pub(super) fn between(seen: &Vector, signature: &Vector) -> Self {
        let mut distance = Self::default();
        for (check, a) in &seen.0 {
            let Some(b) = signature.0.get(check) else { continue };
            if a.state == State::Pass && b.state == State::Pass {
                continue;
            }
            distance.squared += of_check(a, b);
            distance.freedom += 1;
        }
        distance
    }

    pub(super) fn plus(self, other: Self) -> Self {
        Self { squared: self.squared + other.squared, freedom: self.freedom + other.freedom }
    }
}

/// What one check contributes.
pub(super) fn of_check(a: &Seen, b: &Seen) -> f64 {
    use State::{Crash, Numerics, Pass, Timeout, Unclear, Wrong};
    let contribution = match (a.state, b.state) {
        (Pass, Pass) => 0.0,
        (Timeout, Timeout) | (Crash, Crash) => 0.0,
        (Timeout, _) | (_, Timeout) => LATE,
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
    contribution.min(MOST_OF_ONE)
}

/// How far a check that is wrong is from one that passes.
fn from_right(wrong: &Seen) -> f64 {
    let mean = wrong.numbers.iter().filter(|(name, _)| is_ratio(name));
    let furthest = mean.map(|(name, number)| squared(name, *number, Number(0.0, 0.0))).reduce(f64::max);
    furthest.map_or(PLAINLY, |furthest| furthest.max(BARELY))
}

/// True for numbers that are 0 if all is right, since they are logarithms of ratios.
fn is_ratio(name: &str) -> bool {
    name == "mean" || name.starts_with('c') && name[1..].parse::<u32>().is_ok()
}

fn numbers_apart(a: &BTreeMap<String, Number>, b: &BTreeMap<String, Number>) -> f64 {
    let names = a.keys().chain(b.keys().filter(|name| !a.contains_key(*name)));
    names
        .map(|name| match (a.get(name), b.get(name)) {
            (Some(a), Some(b)) => squared(name, *a, *b),
            // A mean without an error is one that could not be told.
            _ if is_ratio(name) || name.starts_with("noise") || name.starts_with("share") => 0.0,
            _ => ANOTHER_FORM,
        })
        .fold(0.0, f64::max)
}

/// The difference of two numbers, squared, in units of what it may be.
fn squared(name: &str, a: Number, b: Number) -> f64 {
    let floor = scale(name, 0.5 * (a.0 + b.0));
    let variance = a.1.powi(2) + b.1.powi(2) + floor.powi(2);
    (a.0 - b.0).powi(2) / variance
}

/// How much a number may differ between two programs with the same mistake, as one standard deviation.
pub(super) fn scale(name: &str, value: f64) -> f64 {
    if name.starts_with("noise") {
        0.3
    } else if name.contains("exponent") {
        0.1
    } else if name.starts_with("deviation") {
        0.5
    } else if name.starts_with("constant") {
        0.02
    } else if name.starts_with("a light") {
        0.1
    } else if name.starts_with("share") {
        0.002 + 0.1 * value.abs()
    } else if name.starts_with("is wrong") {
        0.33
    } else {
        // Logarithms of means: light that is 2 % off, and a sixth of the mistake itself.
        0.02 + 0.15 * value.abs()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seen(state: State, numbers: &[(&str, f64)]) -> Seen {
        let numbers = numbers.iter().map(|&(name, value)| (name.to_owned(), Number(value, 0.0))).collect();
        Seen { state, numbers }
    }

    #[test]
    fn the_same_factor_is_near_and_another_is_far() {
        let factor = |factor: f64| seen(State::Wrong, &[("mean", factor.ln())]);
        assert!(of_check(&factor(2.0), &factor(2.05)) < 1.0);
        assert!(of_check(&factor(2.0), &factor(3.0)) > 4.0);
        assert_eq!(of_check(&factor(2.0), &factor(0.5)), MOST_OF_ONE);
    }

    #[test]
    fn an_error_that_is_barely_seen_is_barely_apart_from_none() {
        let right = seen(State::Pass, &[]);
        assert_eq!(of_check(&right, &seen(State::Wrong, &[("mean", 0.01)])), BARELY);
        assert_eq!(of_check(&right, &seen(State::Wrong, &[("mean", 0.7)])), MOST_OF_ONE);
        assert_eq!(of_check(&seen(State::Wrong, &[]), &right), PLAINLY);
    }

    #[test]
    fn what_only_one_side_has_seen_does_not_count() {
        let vector = |ids: &[&str]| {
            Vector(ids.iter().map(|&id| (id.to_owned(), seen(State::Wrong, &[("mean", 1.0)]))).collect())
        };
        let distance = Distance::between(&vector(&["a", "b"]), &vector(&["b", "c"]));
        assert_eq!(distance, Distance { squared: 0.0, freedom: 1 });
    }
}
