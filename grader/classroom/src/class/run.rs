//! Takes in and grades all submissions of a class, several at once.
//!
//! Each submission renders with one thread and so occupies one core: times are about those of grading it alone, and no
//! core waits while rustc or the grader runs. Verdicts depend only on seeds, not on the number of jobs or the order.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Sender, channel};
use std::time::{Duration, Instant};

use super::changes::vanished_members;
use super::gradebook::Row;
use super::identity::team_key;
use super::inputs::hash_of_inputs;
use super::progress::{Line, Progress};
use super::settle::{Done, Effort, OfTeam, Shared};
use super::similar::{Fingerprint, Starter};
use super::{Class, Member};
use crate::marks::Marks;
use crate::policy::Policy;
use harness::workspace::Workspace;
use intake::{Reader, Wanted};
use judge::grade::{Grader, Options};
use verdict::error::Result;
use verdict::report::Provenance;
use verdict::sandbox::Level;

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
    /// True if the course wants a leaderboard.
    pub leaderboard: bool,
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
    let assignment = workspace.assignment(&options.grade.assignment);
    let wanted = Wanted::new(&grader.rubric().submission, &assignment.starter()?);
    let shared = Shared {
        workspace,
        student_file: grader.rubric().submission.path.clone(),
        marks: Marks::open(&options.out)?,
        base: hash_of_inputs(workspace, &grader, &options.grade)?,
        tasks: grader.rubric().tasks.iter().filter(|task| !task.manual).map(|task| task.id.clone()).collect(),
        starter: Starter::new(&wanted.starter),
        wanted,
        grader,
        class,
        policy,
        options,
    };
    let count = class.members.len();
    let units = units(&class.members);
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
        leaderboard: policy.is_some_and(Policy::has_leaderboard),
    };
    std::thread::scope(|scope| -> Result<()> {
        let (sender, results) = channel();
        for _ in 0..options.jobs.min(units.len()) {
            let (sender, shared, units, next, line) =
                (sender.clone(), &shared, &units, &next, progress.line());
            scope.spawn(move || work(shared, units, next, line, &sender));
        }
        drop(sender);
        let mut saved = Instant::now();
        for (number, done) in results.into_iter().enumerate() {
            progress.ended(number + 1, &done.row.line());
            outcome.graded += usize::from(done.effort == Effort::Graded);
            outcome.unchanged += usize::from(done.effort == Effort::Unchanged);
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

/// Indices of the members who share a submission: those of a team, or one student.
fn units(members: &[Member]) -> Vec<Vec<usize>> {
    let mut teams: BTreeMap<String, usize> = BTreeMap::new();
    let mut units: Vec<Vec<usize>> = Vec::new();
    for (index, member) in members.iter().enumerate() {
        let next = units.len();
        let is_alone = member.team.is_empty();
        let place = if is_alone { next } else { *teams.entry(team_key(&member.team)).or_insert(next) };
        match units.get_mut(place) {
            Some(unit) => unit.push(index),
            None => units.push(vec![index]),
        }
    }
    units
}

/// Grades one student or team after another until none is left or the receiver is gone.
fn work(
    shared: &Shared<'_>,
    units: &[Vec<usize>],
    next: &AtomicUsize,
    mut line: Line,
    results: &Sender<Done>,
) {
    while let Some(unit) = units.get(next.fetch_add(1, Ordering::Relaxed)) {
        let mut team = OfTeam::new();
        for &index in unit {
            let member = &shared.class.members[index];
            line.begin(&member.key);
            if results.send(shared.settle(index, member, &mut team, &mut line)).is_err() {
                return;
            }
        }
    }
}

/// True if a folder contains results of an earlier run.
pub fn has_results(out: &Path) -> bool {
    std::fs::read_dir(out.join("submissions")).is_ok_and(|mut entries| entries.next().is_some())
}
