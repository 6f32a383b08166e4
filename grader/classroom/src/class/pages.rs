//! The pages of one submission of a class. Measurements and images are made once; pages are rewritten when a mark changes.

use jiff::Timestamp;
use jiff::tz::TimeZone;

use super::gradebook::Row;
use super::record::{Record, ResultDir};
use crate::marks::Marks;
use harness::build::SubmissionProgram;
use harness::workspace::Workspace;
use judge::convergence::brief;
use judge::grade::{Grader, Options};
use judge::pictures::pictures;
use judge::reference::Oracle;
use present::page::{Readers, remove_pages, write_pages};
use present::pictures::{load, save, thumbnail};
use present::streams::note;
use verdict::error::{Error, Result};
use verdict::output;
use verdict::report::{HandIn, Report};
use verdict::text::harmless;

/// Number of scenes with images on a page: fewer than for a single grade, since each takes megabytes.
const SCENES: usize = 2;

/// Measures the convergence of a program that has just been graded, renders images, and stores them and a thumbnail.
pub(super) fn complete(
    workspace: &Workspace,
    grader: &Grader,
    program: Option<&SubmissionProgram>,
    report: &mut Report,
    result_dir: &ResultDir,
) -> Result<()> {
    let (seed, Options { threads, .. }) = (grader.public_seed(), grader.options());
    let mut shown = Vec::new();
    if let Some(program) = program {
        let solution = grader.oracle().map(Oracle::program).transpose()?;
        report.convergence = Some(brief(workspace, grader.rubric(), program, solution.as_deref(), seed)?);
        shown = pictures(workspace, grader.rubric(), program, report, *threads, seed, SCENES)?;
    }
    save(&shown, &result_dir.pictures())?;
    match thumbnail(&shown) {
        Some(png) => output::write_bytes(&result_dir.thumbnail(), png),
        None => output::remove(&result_dir.thumbnail()),
    }
}

/// What all pages of a class have in common.
pub(super) struct PageMaker<'a> {
    /// Marks of tutors.
    pub(super) marks: &'a Marks,
    /// Time zone of the course.
    pub(super) zone: TimeZone,
    /// Path of the student file in a checkout.
    pub(super) path: &'a str,
}

impl PageMaker<'_> {
    /// Writes both pages of a submission, graded or refused, unless they are up to date with report, marks and lateness.
    /// Errors are only printed, since pages change no row.
    pub(super) fn make(&self, result_dir: &ResultDir, record: &Record, row: &Row) {
        self.try_to_make(result_dir, record, row).unwrap_or_else(|error| warn(row, &error));
    }

    fn try_to_make(&self, result_dir: &ResultDir, record: &Record, row: &Row) -> Result<()> {
        let hand_in = hand_in(row, &self.zone);
        let mut hasher = blake3::Hasher::new();
        hasher.update(record.key.as_bytes()).update(record.report.as_bytes()).update(self.path.as_bytes());
        hasher.update(format!("{hand_in:?} {:?} {:?}", record.explanations, record.reason).as_bytes());
        for mark in self.marks.of(&row.key, &row.explanation) {
            hasher.update(format!("{mark:?}").as_bytes());
        }
        let made_of = hasher.finalize().to_hex().to_string();
        if std::fs::read_to_string(result_dir.made_of()).is_ok_and(|earlier| earlier == made_of) {
            return Ok(());
        }
        let is_refused = record.report.is_empty();
        let mut report = Report::load(&if is_refused { result_dir.refusal() } else { result_dir.report() })?;
        report.submission.explanations.clone_from(&record.explanations);
        self.marks.apply(&mut report, &row.key);
        report.hand_in = Some(hand_in);
        let shown = load(&result_dir.pictures()).unwrap_or_default();
        write_pages(&report, &shown, &result_dir.report(), Readers::Staff(Some(self.path)))?;
        // Last, so that pages of which one is missing are made again.
        output::write_bytes(&result_dir.made_of(), made_of)
    }
}

/// Says that the pages of a submission are not what they should be.
pub(super) fn warn(row: &Row, error: &Error) {
    note(format_args!("warning: the page of {}: {error}", harmless(&row.key)));
}

/// What the pages say about student and time.
fn hand_in(row: &Row, zone: &TimeZone) -> HandIn {
    let local = |time: Timestamp| time.to_zoned(zone.clone()).strftime("%F %T %Z").to_string();
    let received_at = row.received_at.as_ref().and_then(|time| time.parse().ok());
    let name = row.name();
    HandIn {
        student: if name.is_empty() { row.key.clone() } else { name },
        received_at: received_at.map(local),
        late_by: row.lateness.as_ref().and_then(|lateness| lateness.late_by),
        factor: row.lateness.as_ref().map_or(1.0, |lateness| lateness.factor),
        points: row.points.unwrap_or(0.0),
    }
}

/// Removes the pages of an earlier submission of the same student.
pub(super) fn clear(result_dir: &ResultDir) -> Result<()> {
    output::remove(&result_dir.made_of())?;
    output::remove(&result_dir.thumbnail())?;
    remove_pages(&result_dir.report())
}
