//! Takes in and grades all submissions of a class, several at once.
//!
//! Each submission renders with one thread and so occupies one core: times are about those of grading it alone, and no
//! core waits while rustc or the grader runs. Verdicts depend only on seeds, not on the number of jobs or the order.

use std::collections::{BTreeMap, BTreeSet};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Sender, channel};
use std::time::{Duration, Instant};

use jiff::tz::TimeZone;

use super::changes::{Detail, change, vanished, vanished_members};
use super::gradebook::{Row, State};
use super::identity::team_key;
use super::inputs::hash_of_inputs;
use super::progress::{Line, Progress};
use super::record::{Record, ResultDir};
use super::similar::{Fingerprint, Starter};
use super::{Class, Member, pages};
use crate::marks::Marks;
use crate::policy::{Lateness, Policy, Receipt, the_one_that_counts};
use harness::workspace::Workspace;
use intake::{Intake, Reader, Refusal};
use judge::grade::{Grader, Options};
use present::streams::note;
use verdict::error::{Error, Result};
use verdict::report::Provenance;
use verdict::sandbox::Level;
use verdict::submission::IntakeFinding;
use verdict::text::harmless;

/// Folder in the results in which a preview grades.
pub(super) const PREVIEW: &str = "preview";

/// Options of grading a class.
#[derive(Clone, Debug)]
pub struct RunOptions {
    /// Options of each grade.
    pub grade: Options,
    /// True if reports tell the seed to staff only.
    pub secret_seed: bool,
    /// Number of submissions that are graded at once.
    pub jobs: usize,
    /// Result folder.
    pub out: PathBuf,
    /// True to grade submissions again that have not changed.
    pub regrade: bool,
    /// True to replace nothing: results go to the folder `preview` in `out`, and are compared with those in `out`.
    pub preview: bool,
    /// True to write the pages of each submission, with images.
    pub pages: bool,
    /// Who reads the submissions.
    pub reader: Reader,
}

/// Results of a class.
pub struct Outcome {
    /// One row per member, in their order.
    pub rows: Vec<Row>,
    /// Fingerprints to compare submissions, by row key.
    pub fingerprints: BTreeMap<String, Fingerprint>,
    /// Changes of scores since the last run, as texts.
    pub changes: Vec<String>,
    /// Number of submissions that were graded in this run.
    pub graded: usize,
    /// Number of submissions that have not changed since the last run.
    pub unchanged: usize,
    /// Versions and seeds of all grades.
    pub provenance: Provenance,
    /// Hash of everything that verdicts depend on except the submissions, in hexadecimal.
    pub inputs: String,
    /// Weakest sandbox of all submissions; `None` if none was run.
    pub weakest_sandbox: Option<Level>,
}

/// State that all workers share.
struct Shared<'a> {
    workspace: &'a Workspace,
    /// Path of the student file in a checkout.
    student_file: String,
    grader: Grader,
    class: &'a Class,
    policy: Option<&'a Policy>,
    options: &'a RunOptions,
    starter_text: String,
    starter: Starter,
    /// Hash of everything that verdicts depend on except the submission.
    base: blake3::Hash,
    tasks: Vec<String>,
    /// Marks of tutors.
    marks: Marks,
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
    graded: bool,
}

/// A worker's result for one submission.
struct Done {
    index: usize,
    row: Row,
    fingerprint: Option<Fingerprint>,
    change: Option<String>,
    graded: bool,
    level: Option<Level>,
}

/// Grades a class. `save` is called every few seconds with the rows so far, so that there is always a current table.
///
/// # Errors
/// If no submission can be graded. Errors with a single submission are in its row.
pub fn run(
    workspace: &Workspace,
    class: &Class,
    policy: Option<&Policy>,
    options: &RunOptions,
    mut save: impl FnMut(&[&Row]) -> Result<()>,
) -> Result<Outcome> {
    let grader = Grader::new(workspace, &options.grade)?;
    let grader = if options.secret_seed { grader.with_secret_seed() } else { grader };
    let starter_text = workspace.assignment(&options.grade.assignment).starter()?;
    let student_file = workspace.student_file();
    let student_file = student_file.strip_prefix(workspace.root()).unwrap_or(&student_file);
    let shared = Shared {
        workspace,
        student_file: student_file.display().to_string(),
        marks: Marks::open(&options.out)?,
        base: hash_of_inputs(workspace, &grader, &options.grade)?,
        tasks: grader.rubric().tasks.iter().filter(|task| !task.manual).map(|task| task.id.clone()).collect(),
        starter: Starter::new(&starter_text),
        starter_text,
        grader,
        class,
        policy,
        options,
    };
    let count = class.members.len();
    let progress = Progress::new(count);
    let next = AtomicUsize::new(0);
    let mut rows: Vec<Option<Row>> = vec![None; count];
    let mut outcome = Outcome {
        rows: Vec::new(),
        fingerprints: BTreeMap::new(),
        changes: Vec::new(),
        graded: 0,
        unchanged: 0,
        provenance: shared.grader.provenance().clone(),
        inputs: shared.base.to_hex().to_string(),
        weakest_sandbox: None,
    };
    std::thread::scope(|scope| -> Result<()> {
        let (sender, results) = channel();
        for _ in 0..options.jobs.min(count) {
            let (sender, shared, next, line) = (sender.clone(), &shared, &next, progress.line());
            scope.spawn(move || work(shared, next, line, &sender));
        }
        drop(sender);
        let mut saved = Instant::now();
        for (number, done) in results.into_iter().enumerate() {
            progress.ended(number + 1, &done.row.line());
            outcome.graded += usize::from(done.graded);
            outcome.unchanged += usize::from(!done.graded && done.row.state == State::Graded);
            outcome.changes.extend(done.change);
            outcome.weakest_sandbox = outcome.weakest_sandbox.into_iter().chain(done.level).min();
            outcome.fingerprints.extend(done.fingerprint.map(|print| (done.row.key.clone(), print)));
            rows[done.index] = Some(done.row);
            if saved.elapsed() > Duration::from_secs(5) {
                save(&rows.iter().flatten().collect::<Vec<_>>())?;
                saved = Instant::now();
            }
        }
        Ok(())
    })?;
    progress.finish();
    outcome.rows = rows.into_iter().flatten().collect();
    outcome.changes.extend(vanished_members(&options.out, class));
    outcome.changes.sort();
    outcome.keep_one_fingerprint_of_each_team();
    Ok(outcome)
}

impl Outcome {
    /// A team has one submission: its members did not copy from each other.
    pub(super) fn keep_one_fingerprint_of_each_team(&mut self) {
        let mut teams = BTreeSet::new();
        for row in self.rows.iter().filter(|row| !row.team.is_empty()) {
            if !teams.insert(team_key(&row.team)) {
                self.fingerprints.remove(&row.key);
            }
        }
    }
}

/// Grades one submission after another until none is left or the receiver is gone.
fn work(shared: &Shared<'_>, next: &AtomicUsize, mut line: Line, results: &Sender<Done>) {
    loop {
        let index = next.fetch_add(1, Ordering::Relaxed);
        let Some(member) = shared.class.members.get(index) else { return };
        line.begin(&member.key);
        if results.send(shared.settle(index, member, &mut line)).is_err() {
            return;
        }
    }
}

impl Shared<'_> {
    /// Grades one member of the class and makes its row. Errors become part of the row.
    fn settle(&self, index: usize, member: &Member, line: &mut Line) -> Done {
        let mut result_dir = ResultDir::new(&self.options.out, &member.key);
        let before = result_dir.load();
        if self.options.preview {
            result_dir = ResultDir::new(&self.options.out.join(PREVIEW), &member.key);
        }
        // A fault of the grader in one submission must not cost the others theirs.
        let attempt =
            catch_unwind(AssertUnwindSafe(|| self.attempt(member, &result_dir, before.as_ref(), line)))
                .unwrap_or_else(|_| Err(Error::Harness("the grader panicked".to_owned())));
        match attempt {
            Ok(Some(settled)) => {
                let Settled { record, fingerprint, lateness, receipt, graded } = settled;
                let detail = if self.options.preview { Detail::Checks } else { Detail::Points };
                let change = before.as_ref().and_then(|before| change(&member.key, before, &record, detail));
                let row = self.marked(Row::of_record(member, &record, lateness, receipt.as_ref()));
                self.pages(&result_dir, &record, &row);
                Done { index, row, fingerprint, change, graded, level: record.sandbox }
            }
            Ok(None) => {
                let change = before.as_ref().map(|before| vanished(&member.key, before));
                let row = self.marked(Row::missing(member));
                Done { index, row, fingerprint: None, change, graded: false, level: None }
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
                Done { index, row, fingerprint: None, change: None, graded: false, level: None }
            }
        }
    }

    /// A row with its marks and penalty.
    fn marked(&self, mut row: Row) -> Row {
        row.apply(&self.marks, self.policy.map(Policy::rules));
        row
    }

    /// Writes the pages of a submission. Errors are only printed, since pages change no row.
    fn pages(&self, result_dir: &ResultDir, record: &Record, row: &Row) {
        let zone = self.policy.map_or(TimeZone::UTC, |policy| policy.zone().clone());
        let made = match (self.options.pages, record.report.is_empty()) {
            (true, false) => pages::make(result_dir, record, &self.marks, row, &zone, &self.student_file),
            _ => pages::clear(result_dir),
        };
        if let Err(error) = made {
            note(format_args!("warning: the page of {}: {error}", harmless(&row.key)));
        }
    }

    /// Takes in and grades the submission of a member; `None` if there is none.
    fn attempt(
        &self,
        member: &Member,
        result_dir: &ResultDir,
        before: Option<&Record>,
        line: &mut Line,
    ) -> Result<Option<Settled>> {
        let Some(Taken { intake, receipt, lateness }) = self.take(member)? else { return Ok(None) };
        let source = intake.outcome.as_ref().map_or("", |submission| submission.source.as_str());
        let key = self.key(source);
        let fingerprint = intake.outcome.is_ok().then(|| self.starter.fingerprint(source));
        let mut record = Record::new(key, &intake, &self.tasks, None);
        let mut graded = match &intake.outcome {
            Err(_) => None,
            Ok(_) if !self.options.regrade && before.is_some_and(|before| before.key == record.key) => {
                // What came with the source may have changed, though the verdicts have not.
                if let Some(before) = before {
                    let Record { notes, explanations, checksums, .. } = record;
                    record = Record { notes, explanations, checksums, ..before.clone() };
                }
                return Ok(Some(Settled { record, fingerprint, lateness, receipt, graded: false }));
            }
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
        Ok(Some(Settled { record, fingerprint, lateness, receipt, graded: graded.is_some() }))
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
        let intake = self.options.reader.take(paths, &self.starter_text, source)?;
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

/// True if a folder contains results of an earlier run.
pub fn has_results(out: &Path) -> bool {
    std::fs::read_dir(out.join("submissions")).is_ok_and(|mut entries| entries.next().is_some())
}
