//! Takes in and grades the submission of one member of the class. The members of a team share one.

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

use jiff::tz::TimeZone;

use super::changes::{Detail, change, vanished};
use super::gradebook::Row;
use super::pages::PageMaker;
use super::progress::Line;
use super::record::{Record, ResultDir};
use super::run::{PREVIEW, RunOptions};
use super::similar::{Fingerprint, Starter};
use super::{Class, Member, pages};
use crate::marks::Marks;
use crate::policy::{Lateness, Policy, Receipt, the_one_that_counts};
use harness::workspace::Workspace;
use intake::{Intake, Refusal, Wanted};
use judge::grade::Grader;
use present::streams::note;
use verdict::error::{Error, Result};
use verdict::sandbox::Level;
use verdict::submission::IntakeFinding;
use verdict::text::harmless;

/// State that all workers share.
pub(super) struct Shared<'a> {
    pub(super) workspace: &'a Workspace,
    /// Path of the student file in a checkout.
    pub(super) student_file: String,
    pub(super) grader: Grader,
    pub(super) class: &'a Class,
    pub(super) policy: Option<&'a Policy>,
    pub(super) options: &'a RunOptions,
    pub(super) wanted: Wanted,
    pub(super) starter: Starter,
    /// Hash of everything that verdicts depend on except the submission.
    pub(super) base: blake3::Hash,
    pub(super) tasks: Vec<String>,
    /// Marks of tutors.
    pub(super) marks: Marks,
}

/// The submission that counts of one member.
struct Taken {
    intake: Intake,
    receipt: Option<Receipt>,
    lateness: Option<Lateness>,
}

/// A submission that has been taken in and graded.
struct Settled {
    record: Record,
    fingerprint: Option<Fingerprint>,
    lateness: Option<Lateness>,
    receipt: Option<Receipt>,
    effort: Effort,
}

/// What a result of this run has cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Effort {
    /// Nothing: there is no submission to grade.
    Nothing,
    /// It was graded.
    Graded,
    /// It was copied from another member of the team.
    Copied,
    /// It has not changed since the last run.
    Unchanged,
}

/// Results of the members of one team, so far: each with the folder that it is in.
pub(super) type OfTeam = Vec<(ResultDir, Record)>;

/// A worker's result for one submission.
pub(super) struct Done {
    pub(super) index: usize,
    pub(super) row: Row,
    pub(super) fingerprint: Option<Fingerprint>,
    pub(super) change: Option<String>,
    pub(super) effort: Effort,
    pub(super) level: Option<Level>,
}

impl Shared<'_> {
    /// Grades one member of the class and makes its row. Errors become part of the row.
    /// `team` holds the results of other members of the same team.
    pub(super) fn settle(&self, index: usize, member: &Member, team: &mut OfTeam, line: &mut Line) -> Done {
        let mut result_dir = ResultDir::new(&self.options.out, &member.key);
        let before = result_dir.load();
        if self.options.preview {
            result_dir = ResultDir::new(&self.options.out.join(PREVIEW), &member.key);
        }
        // A fault of the grader in one submission must not cost the others theirs.
        let attempt =
            catch_unwind(AssertUnwindSafe(|| self.attempt(member, &result_dir, before.as_ref(), team, line)))
                .unwrap_or_else(|_| Err(Error::Harness("the grader panicked".to_owned())));
        match attempt {
            Ok(Some(settled)) => {
                let Settled { record, fingerprint, lateness, receipt, effort } = settled;
                let detail = if self.options.preview { Detail::Checks } else { Detail::Points };
                let change = before.as_ref().and_then(|before| change(&member.key, before, &record, detail));
                let row = self.marked(Row::of_record(member, &record, lateness, receipt.as_ref()));
                self.pages(&result_dir, &record, &row);
                Done { index, row, fingerprint, change, effort, level: record.sandbox }
            }
            Ok(None) => {
                let change = before.as_ref().map(|before| vanished(&member.key, before));
                let row = self.marked(Row::missing(member));
                Done { index, row, fingerprint: None, change, effort: Effort::Nothing, level: None }
            }
            Err(error) => {
                let trouble = IntakeFinding { code: "harness".to_owned(), message: error.to_string() };
                let row = match before {
                    // The last good result is kept.
                    Some(record) => {
                        let receipt = member.receipts.last();
                        let lateness = self
                            .policy
                            .map(|policy| policy.judge(&member.names(), receipt, &record.checksums));
                        let row = self.marked(Row::of_record(member, &record, lateness, receipt));
                        Row { kept: true, reason: Some(trouble), ..row }
                    }
                    None => Row::harness(member, trouble),
                };
                Done { index, row, fingerprint: None, change: None, effort: Effort::Nothing, level: None }
            }
        }
    }

    /// A row with its marks and penalty.
    fn marked(&self, mut row: Row) -> Row {
        row.apply(&self.marks, self.policy.map(Policy::rules));
        row
    }

    /// Writes the pages of a submission, or removes earlier ones if none are wanted.
    fn pages(&self, result_dir: &ResultDir, record: &Record, row: &Row) {
        if !self.options.pages {
            return pages::clear(result_dir).unwrap_or_else(|error| pages::warn(row, &error));
        }
        let zone = self.policy.map_or(TimeZone::UTC, |policy| policy.zone().clone());
        PageMaker { marks: &self.marks, zone, path: &self.student_file }.make(result_dir, record, row);
    }

    /// Takes in and grades the submission of a member; `None` if there is none.
    fn attempt(
        &self,
        member: &Member,
        result_dir: &ResultDir,
        before: Option<&Record>,
        team: &mut OfTeam,
        line: &mut Line,
    ) -> Result<Option<Settled>> {
        let Some(Taken { intake, receipt, lateness }) = self.take(member)? else { return Ok(None) };
        let source = intake.outcome.as_ref().map_or("", |submission| submission.source.as_str());
        result_dir.keep_source(intake.outcome.is_ok().then_some(source))?;
        let key = self.key(source);
        let fingerprint = intake.outcome.is_ok().then(|| self.starter.fingerprint(source));
        let mut record = Record::new(key, &intake, &self.tasks, None);
        // What came with the source may have changed, though the verdicts have not.
        let with_verdicts_of = |other: &Record| {
            let Record { notes, explanations, checksums, .. } = record.clone();
            Record { notes, explanations, checksums, ..other.clone() }
        };
        if intake.outcome.is_ok() {
            let earlier = before.filter(|before| !self.options.regrade && before.key == record.key);
            if let Some(record) = earlier.map(with_verdicts_of) {
                team.push((ResultDir::new(&self.options.out, &member.key), record.clone()));
                return Ok(Some(Settled {
                    record,
                    fingerprint,
                    lateness,
                    receipt,
                    effort: Effort::Unchanged,
                }));
            }
            if let Some((from, other)) = team.iter().find(|(_, other)| other.key == record.key) {
                let record = with_verdicts_of(other);
                pages::clear(result_dir)?;
                result_dir.save_copy(&record, from)?;
                return Ok(Some(Settled { record, fingerprint, lateness, receipt, effort: Effort::Copied }));
            }
        }
        let refusal = match &intake.outcome {
            Err(refusal) if self.options.pages => {
                Some(self.grader.refuse(Path::new(&member.label), &refusal.into())?)
            }
            _ => None,
        };
        result_dir.keep_refusal(refusal.as_ref())?;
        let mut graded = match &intake.outcome {
            Err(_) => None,
            Ok(submission) => Some(self.grader.grade_and_keep(submission, |check| line.check(check))?),
        };
        let report = graded.as_ref().map(|(report, _)| report);
        if let Some(report) = report {
            record = Record::new(record.key, &intake, &self.tasks, Some(report));
        }
        pages::clear(result_dir)?;
        result_dir.save(&mut record, report)?;
        if let (Some((report, program)), true) = (&mut graded, self.options.pages) {
            match pages::complete(self.workspace, &self.grader, program.as_ref(), report, result_dir) {
                Ok(()) => result_dir.save(&mut record, Some(report))?,
                Err(error) => {
                    let whose = harmless(&member.key);
                    note(format_args!("warning: the report of {whose} is incomplete: {error}"));
                }
            }
        }
        let effort = if graded.is_some() { Effort::Graded } else { Effort::Nothing };
        if effort == Effort::Graded {
            team.push((result_dir.clone(), record.clone()));
        }
        Ok(Some(Settled { record, fingerprint, lateness, receipt, effort }))
    }

    /// Takes in the submissions of a member and selects the one that counts; `None` if there is none.
    fn take(&self, member: &Member) -> Result<Option<Taken>> {
        let names = member.names();
        let paths_of = |receipt: &Receipt| {
            let named = !receipt.path.is_empty();
            if named { vec![self.class.folder.join(&receipt.path)] } else { member.paths.clone() }
        };
        let mut taken: BTreeMap<String, Intake> = BTreeMap::new();
        for receipt in &member.receipts {
            let paths = paths_of(receipt);
            if !paths.is_empty() {
                taken.insert(receipt.path.clone(), self.read(&paths, Some(receipt))?);
            }
        }
        let there: Vec<Receipt> =
            member.receipts.iter().filter(|receipt| taken.contains_key(&receipt.path)).cloned().collect();
        let counts = self.policy.and_then(|policy| {
            the_one_that_counts(policy, &names, &there, |receipt| taken[&receipt.path].checksums.clone())
        });
        if let Some((receipt, lateness)) = counts {
            let receipt = receipt.clone();
            return Ok(taken.remove(&receipt.path).map(|intake| Taken {
                intake,
                receipt: Some(receipt),
                lateness: Some(lateness),
            }));
        }
        if member.paths.is_empty() {
            return Ok(None);
        }
        let intake = self.read(&member.paths, member.receipts.first())?;
        let lateness = self.policy.map(|policy| policy.judge(&names, None, &intake.checksums));
        Ok(Some(Taken { intake, receipt: None, lateness }))
    }

    /// Reads a submission; its receipt may say which file of it is the source.
    fn read(&self, paths: &[PathBuf], receipt: Option<&Receipt>) -> Result<Intake> {
        let source = receipt.and_then(|receipt| receipt.source.as_deref());
        let intake = self.options.reader.take(paths, &self.wanted, source)?;
        match &intake.outcome {
            // The manifest is wrong, which must not cost the student anything.
            Err(refusal @ Refusal::NotThere(..)) => {
                Err(Error::Input(format!("the column `source` of the manifest: {refusal}")))
            }
            _ => Ok(intake),
        }
    }

    fn key(&self, source: &str) -> String {
        let mut hasher = blake3::Hasher::new();
        hasher.update(self.base.as_bytes()).update(source.as_bytes());
        hasher.finalize().to_hex().to_string()
    }
}
