//! The observations of a report's checks, as numbers that can be compared.

use std::collections::{BTreeMap, BTreeSet};

use arty::integrator::Technique;
use serde::{Deserialize, Serialize};
use verdict::check::{CheckId, CheckResult, Reason, Verdict};
use verdict::report::Report;

use crate::checks::{Quantity, of_kind};

/// Result of a check, reduced to what matters for the cause.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CheckState {
    /// It passed.
    Pass,
    /// Too noisy to decide.
    Unclear,
    /// It failed for the property that it tests, such as the mean or the weights.
    Wrong,
    /// Samples that are not radiance.
    Numerics,
    /// It exceeded its time limit.
    Timeout,
    /// The submission panicked, died or violated the protocol.
    Crash,
}

impl CheckState {
    /// All states with their letters in files.
    pub(super) const LETTERS: [(CheckState, char); 6] = [
        (CheckState::Pass, '.'),
        (CheckState::Unclear, '?'),
        (CheckState::Wrong, 'F'),
        (CheckState::Numerics, 'N'),
        (CheckState::Timeout, 'T'),
        (CheckState::Crash, 'C'),
    ];

    fn of(check: &CheckResult) -> Option<Self> {
        match (&check.verdict, check.reason) {
            (Verdict::Skipped { .. } | Verdict::NotRun { .. }, _) => None,
            (Verdict::Pass, _) => Some(Self::Pass),
            (_, Reason::Timeout) => Some(Self::Timeout),
            (_, Reason::Crash | Reason::Violation) => Some(Self::Crash),
            (Verdict::Inconclusive, _) => Some(Self::Unclear),
            (Verdict::Fail, Reason::Numerics) => Some(Self::Numerics),
            (Verdict::Fail, _) => Some(Self::Wrong),
        }
    }
}

/// A measured value and its standard error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Number(pub f64, pub f64);

/// The observations of one check.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckObservations {
    /// Result of the check.
    pub state: CheckState,
    /// Measured quantities; empty if it passed.
    pub numbers: BTreeMap<Quantity, Number>,
}

/// The observations of all checks of a report.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ObservationVector(pub BTreeMap<CheckId, CheckObservations>);

impl ObservationVector {
    /// The observations of a report's checks that were run, of the techniques that students write, without kinds whose scenes
    /// depend on the seed.
    pub fn of(report: &Report, student_techniques: &[Technique]) -> Self {
        let seen = |check: &CheckResult| {
            if check.id.kind.draws_scenes() || !student_techniques.contains(&check.id.technique) {
                return None;
            }
            let state = CheckState::of(check)?;
            let numbers = if state == CheckState::Pass { BTreeMap::new() } else { numbers(check) };
            Some((check.id.clone(), CheckObservations { state, numbers }))
        };
        Self(report.checks.iter().filter_map(seen).collect())
    }

    /// True if all checks passed.
    pub fn all_pass(&self) -> bool {
        self.0.values().all(|seen| seen.state == CheckState::Pass)
    }

    /// The observations of a grade that stops each task after this many checks that do not pass. `order` lists task and
    /// identity of all checks in the order in which they are run.
    pub fn stopped_after(&self, order: &[(String, CheckId)], failures: usize) -> Self {
        let mut failed: BTreeMap<&str, usize> = BTreeMap::new();
        let mut stopped = Self::default();
        for (task, check) in order {
            let count = failed.entry(task).or_default();
            if let Some(seen) = self.0.get(check).filter(|_| *count < failures) {
                *count += usize::from(seen.state != CheckState::Pass);
                stopped.0.insert(check.clone(), seen.clone());
            }
        }
        stopped
    }

    /// The techniques of its checks.
    pub(super) fn techniques(&self) -> BTreeSet<Technique> {
        self.0.keys().map(|id| id.technique).collect()
    }

    /// The checks of a technique.
    pub(super) fn of_technique(&self, technique: Technique) -> Self {
        self.clone().without(|other| other != technique)
    }

    /// Removes the checks of some techniques.
    pub(super) fn without(mut self, is_excluded: impl Fn(Technique) -> bool) -> Self {
        self.0.retain(|id, _| !is_excluded(id.technique));
        self
    }
}

/// The measurements of a check that did not pass.
fn numbers(check: &CheckResult) -> BTreeMap<Quantity, Number> {
    let Some(evidence) = &check.evidence else { return BTreeMap::new() };
    let observations = of_kind(check.id.kind).observations(evidence).into_iter();
    let finite = observations.filter(|it| it.value.is_finite() && it.error.is_finite());
    finite.map(|it| (it.quantity, Number(it.value, it.error))).collect()
}
