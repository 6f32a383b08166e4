//! Data of the class's page from the records of submissions: little of each, so that a large class fits into memory.

use std::collections::BTreeMap;
use std::path::Path;

use crate::class::gradebook::{Row, State};
use crate::class::record::{Record, ResultDir};
use verdict::check::Verdict;

/// Data of one submission.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Digest {
    /// Seconds for compiling and running.
    pub(super) seconds: Option<f64>,
    /// Work for a given noise; see [`Record::work`].
    pub(super) work: Option<f64>,
    /// Index in [`Digests::alike`]; none if it passes everything.
    pub(super) group: Option<usize>,
    /// True if its pages exist.
    pub(super) pages: bool,
}

/// How often a check was run, and how often it passed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Rate {
    pub(super) run: usize,
    pub(super) passed: usize,
}

/// Submissions with the same most likely mistake.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Alike {
    /// The mistake, or the checks that failed.
    pub(super) what: String,
    /// True if it is a likely cause, false if it is the set of failed checks.
    pub(super) is_cause: bool,
    /// Indices of their rows.
    pub(super) rows: Vec<usize>,
}

/// Data of a class.
#[derive(Debug, Default)]
pub(super) struct Digests {
    /// Submissions in the order of the rows.
    pub(super) of_rows: Vec<Digest>,
    /// Pass rates, by task and check.
    pub(super) checks: BTreeMap<String, Rate>,
    /// Groups of submissions with the same mistake, the largest first.
    pub(super) alike: Vec<Alike>,
}

impl Digests {
    /// Reads all records, one at a time.
    pub(super) fn read(out: &Path, rows: &[Row]) -> Self {
        let mut digests = Self::default();
        let mut groups: BTreeMap<(bool, String), Vec<usize>> = BTreeMap::new();
        for (index, row) in rows.iter().enumerate() {
            let result_dir = ResultDir::new(out, &row.key);
            let record = (row.state == State::Graded).then(|| result_dir.record_alone()).flatten();
            let pages = record.is_some() && result_dir.pages().iter().all(|page| page.is_file());
            let mut digest = Digest { pages, ..Digest::default() };
            if let Some(record) = &record {
                digest.seconds = Some(record.seconds);
                digest.work = record.work;
                let run =
                    record.checks.iter().filter(|(_, verdict)| !matches!(verdict, Verdict::Skipped { .. }));
                for (check, verdict) in run {
                    let rate = digests.checks.entry(check.clone()).or_default();
                    rate.run += 1;
                    rate.passed += usize::from(*verdict == Verdict::Pass);
                }
                if let Some(shared) = shared(record) {
                    groups.entry(shared).or_default().push(index);
                }
            }
            digests.of_rows.push(digest);
        }
        digests.alike =
            groups.into_iter().map(|((is_cause, what), rows)| Alike { what, is_cause, rows }).collect();
        digests.alike.sort_by_key(|group| std::cmp::Reverse(group.rows.len()));
        for (place, group) in digests.alike.iter().enumerate() {
            group.rows.iter().for_each(|&row| digests.of_rows[row].group = Some(place));
        }
        digests
    }
}

/// Key of the group of a submission: its most likely cause, or else its failed checks; `None` if it passes everything.
fn shared(record: &Record) -> Option<(bool, String)> {
    if let Some(mistake) = &record.mistake {
        return Some((true, mistake.clone()));
    }
    if let Some(reason) = record.reason.as_ref().filter(|_| record.checks.is_empty()) {
        return Some((false, reason.message.clone()));
    }
    let lacking = |verdict: &Verdict| !matches!(verdict, Verdict::Pass | Verdict::Skipped { .. });
    let failed = record.checks.iter().filter(|(_, verdict)| lacking(verdict));
    let failed: Vec<&str> = failed.map(|(check, _)| check.as_str()).collect();
    (!failed.is_empty()).then(|| (false, failed.join(", ")))
}
