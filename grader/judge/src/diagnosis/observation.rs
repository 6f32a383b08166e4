//! What the checks of a report saw, as numbers that can be compared.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use verdict::report::{CheckResult, Reason, Report, Verdict};
use verdict::rubric::CheckKind;

/// How a check ended, as far as it matters for the cause.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// What was looked for is right.
    Pass,
    /// Too noisy to tell.
    Unclear,
    /// A wrong mean, wrong weights, shared random numbers: what the check is for.
    Wrong,
    /// Samples that are no radiance.
    Numerics,
    /// It took too long.
    Timeout,
    /// It panicked, died, or answered with what was not asked for.
    Crash,
}

impl State {
    /// All of them, each with the letter that stands for it in files.
    pub(super) const LETTERS: [(State, char); 6] = [
        (State::Pass, '.'),
        (State::Unclear, '?'),
        (State::Wrong, 'F'),
        (State::Numerics, 'N'),
        (State::Timeout, 'T'),
        (State::Crash, 'C'),
    ];

    fn of(check: &CheckResult) -> Option<Self> {
        match (check.verdict, check.reason) {
            (Verdict::LeftOut | Verdict::Error, _) | (_, Reason::Harness) => None,
            (Verdict::Pass, _) => Some(Self::Pass),
            (_, Reason::Timeout) => Some(Self::Timeout),
            (_, Reason::Crash | Reason::Violation) => Some(Self::Crash),
            (Verdict::Inconclusive, _) => Some(Self::Unclear),
            (Verdict::Fail, Reason::Numerics) => Some(Self::Numerics),
            (Verdict::Fail, _) => Some(Self::Wrong),
        }
    }
}

/// A measured number with its standard error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Number(pub f64, pub f64);

/// What one check saw.
#[derive(Clone, Debug, PartialEq)]
pub struct Seen {
    /// How it ended.
    pub state: State,
    /// Numbers by name; none where it passed. What they mean, and how exact they can be, is up to
    /// `scale` of the module `distance`.
    pub numbers: BTreeMap<String, Number>,
}

/// What all checks of a report saw, by the name of the check.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Vector(pub BTreeMap<String, Seen>);

impl Vector {
    /// Of a report. Checks that were not run, for whatever reason, are not in it, nor are those whose scenes are other ones
    /// with each seed.
    pub fn of(report: &Report) -> Self {
        let seen = |check: &CheckResult| {
            if check.check == CheckKind::HiddenVariants || check.explanation.starts_with(NOT_RUN) {
                return None;
            }
            let state = State::of(check)?;
            let numbers = if state == State::Pass { BTreeMap::new() } else { numbers(check) };
            Some((check.id.clone(), Seen { state, numbers }))
        };
        Self(report.checks.iter().filter_map(seen).collect())
    }

    /// True if no check has anything to complain of.
    pub fn is_right(&self) -> bool {
        self.0.values().all(|seen| seen.state == State::Pass)
    }

    /// What a grade would have seen that stops in each task after so many checks that do not pass. `order` has task and
    /// name of all checks, in the order in which they are run.
    pub fn stopped_after(&self, order: &[(String, String)], failures: usize) -> Self {
        let mut failed: BTreeMap<&str, usize> = BTreeMap::new();
        let mut stopped = Self::default();
        for (task, check) in order {
            let count = failed.entry(task).or_default();
            if let Some(seen) = self.0.get(check).filter(|_| *count < failures) {
                *count += usize::from(seen.state != State::Pass);
                stopped.0.insert(check.clone(), seen.clone());
            }
        }
        stopped
    }

    /// The checks of a technique.
    pub(super) fn of_technique(&self, technique: &str) -> Self {
        self.clone().without(|other| other != technique)
    }

    /// Without the checks of some techniques.
    pub(super) fn without(mut self, technique_is: impl Fn(&str) -> bool) -> Self {
        self.0.retain(|id, _| !technique_is(technique(id)));
        self
    }
}

/// The technique that a check asks for, from its name.
pub(super) fn technique(check: &str) -> &str {
    check.split('/').nth(2).unwrap_or_default()
}

/// How the explanation of a check begins that was not run, since earlier ones ran out of time.
const NOT_RUN: &str = "not run";

/// How the names of places begin in which something is wrong.
pub(super) const PLACE: &str = "is wrong ";

/// The darkest that a mean counts as, relative to what it should be: black has no logarithm.
const DARKEST: f64 = 0.02;

/// ln of a ratio, cut off where it is nearly black.
fn log(ratio: f64, error: f64) -> Number {
    let ratio_kept = ratio.clamp(DARKEST, 1e4);
    Number(ratio_kept.ln(), error / ratio_kept)
}

/// 99 % intervals are this many standard errors to either side, about.
const INTERVAL: f64 = 2.6;

/// The numbers of a check that did not pass.
fn numbers(check: &CheckResult) -> BTreeMap<String, Number> {
    let mut numbers = BTreeMap::new();
    let mut add = |name: &str, number: Number| {
        if number.0.is_finite() && number.1.is_finite() {
            numbers.insert(name.to_owned(), number);
        }
    };
    if let Some([effect, margin]) = check.whole() {
        add("mean", log(1.0 + effect, margin / INTERVAL));
    }
    for (order, &c) in check.coefficients.iter().enumerate() {
        add(&format!("c{order}"), log(c, 0.0));
    }
    for variance in &check.variance_ratios {
        add(&format!("noise {}", variance.technique), log(variance.ratio, 0.0));
    }
    if let Some(weights) = &check.weights {
        for (name, side) in [("light", weights.light_exponents), ("bsdf", weights.bsdf_exponents)] {
            for (index, exponent) in side.iter().flatten().enumerate() {
                add(&format!("{name} exponent {index}"), Number(*exponent, 0.0));
            }
        }
    }
    for (name, &value) in &check.details {
        match check.check {
            _ if name.starts_with("whole image") => {}
            CheckKind::Metamorphic | CheckKind::Stability | CheckKind::Randomness => {
                add(&format!("{PLACE}{name}"), Number(1.0, 0.0));
            }
            CheckKind::LightPick => add(&format!("share {name}"), log(1.0 + value, 0.0)),
            CheckKind::MisWeights if name.starts_with("deviation") => {
                add(name, Number(value.clamp(1e-4, 10.0).log10(), 0.0));
            }
            CheckKind::MisWeights => add(name, Number(value, 0.0)),
            _ => {}
        }
    }
    numbers
}
