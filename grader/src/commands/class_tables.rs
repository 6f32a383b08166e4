//! The files of a graded class: gradebook, data, page, and the tables of course systems.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use classroom::class::gradebook::{Row, State, save_class, save_gradebook};
use classroom::class::page::{ClassPage, save_leaderboard};
use classroom::class::similar::Archive;
use classroom::class::{Outcome, feedback, similar, systems};
use classroom::policy::Standing;
use present::streams::{note, print_line};
use present::words::count;
use verdict::error::{Error, Result};
use verdict::output;
use verdict::rubric::Rubric;

/// The tables of course systems.
#[derive(clap::Args)]
pub(super) struct Systems {
    /// Moodle's grading worksheet; a completed copy is written to --out
    #[arg(long, value_name = "FILE")]
    pub(super) moodle: Option<PathBuf>,
    /// The status.csv of an ILIAS exercise; a completed copy is written to --out
    #[arg(long, value_name = "FILE")]
    pub(super) ilias: Option<PathBuf>,
    /// Also write the students' reports as archives for --moodle and --ilias to upload: feedback-moodle.zip,
    /// feedback-ilias.zip
    #[arg(long, conflicts_with = "no_report")]
    pub(super) feedback: bool,
}

impl Systems {
    /// # Errors
    /// If feedback is wanted for no course system.
    pub(super) fn check(&self) -> Result<()> {
        let has_system = self.moodle.is_some() || self.ilias.is_some();
        let missing =
            || Error::Input("--feedback needs --moodle or --ilias, whose names its folders have".into());
        (has_system || !self.feedback).then_some(()).ok_or_else(missing)
    }
}

/// Where and how the files of a class are written.
pub(super) struct Tables<'a> {
    pub(super) systems: &'a Systems,
    pub(super) rubric: &'a Rubric,
    /// Result folder.
    pub(super) out: &'a Path,
    /// True to write the page.
    pub(super) page: bool,
}

impl Tables<'_> {
    /// Saves the gradebook of the rows so far.
    pub(super) fn save_gradebook(&self, rows: &[&Row]) -> Result<()> {
        let tasks: Vec<String> = self.rubric.tasks.iter().map(|task| task.id.clone()).collect();
        save_gradebook(&self.out.join("gradebook.csv"), rows, &tasks)
    }

    /// Prints a summary, and writes gradebook.csv, class.json, similar.txt, the page, and the tables of course systems.
    pub(super) fn save(&self, outcome: &Outcome, with_changes: bool) -> Result<()> {
        let (rubric, out) = (self.rubric, self.out);
        let similar = similar::groups(&outcome.fingerprints, &BTreeMap::new());
        print(outcome, similar.len(), with_changes)?;
        self.save_gradebook(&outcome.rows.iter().collect::<Vec<_>>())?;
        let automatic_max = rubric.tasks.iter().filter(|task| !task.manual).map(|task| task.points).sum();
        let assignment = (rubric.assignment.as_str(), automatic_max);
        save_class(&out.join("class.json"), assignment, &outcome.provenance, &outcome.rows, &similar)?;
        output::write_bytes(&out.join("similar.txt"), similar::describe(&similar))?;
        Archive::new(&rubric.assignment, outcome.fingerprints.clone()).save(out)?;
        if outcome.leaderboard {
            let file = out.join("leaderboard.html");
            save_leaderboard(&file, &outcome.rows, out)?;
            note(format_args!("leaderboard: {}", file.display()));
        }
        note(format_args!("gradebook: {}", out.join("gradebook.csv").display()));
        if self.page {
            let (rows, changes) = (&outcome.rows, &outcome.changes);
            let page = ClassPage { rubric, rows, changes, similar: similar.len(), out };
            let file = out.join("class.html");
            page.save(&file)?;
            note(format_args!("page: {}", file.display()));
        }
        if self.systems.moodle.is_some() || self.systems.ilias.is_some() {
            self.warn_of_unmarked(&outcome.rows);
        }
        if let Some(from) = &self.systems.moodle {
            let filled = systems::fill_moodle(from, &out.join("moodle.csv"), &outcome.rows)?;
            report_filled("Moodle", &filled);
            self.save_feedback("feedback-moodle.zip", &filled)?;
        }
        if let Some(from) = &self.systems.ilias {
            let filled = systems::fill_ilias(from, &out.join("status.csv"), &outcome.rows)?;
            report_filled("ILIAS", &filled);
            self.save_feedback("feedback-ilias.zip", &filled)?;
        }
        Ok(())
    }

    /// Writes the archive of reports for a course system, if it is asked for.
    fn save_feedback(&self, name: &str, filled: &systems::Filled) -> Result<()> {
        if self.systems.feedback {
            let path = self.out.join(name);
            let reports = feedback::save(&path, self.out, &filled.feedback)?;
            note(format_args!("{}: {}", path.display(), count(reports, "report")));
        }
        Ok(())
    }

    /// Warns before grades are written that lack the points of a tutor.
    fn warn_of_unmarked(&self, rows: &[Row]) {
        for task in self.rubric.tasks.iter().filter(|task| task.manual) {
            let is_unmarked = |row: &&Row| row.unmarked(self.rubric).any(|other| other == task.id);
            let unmarked: Vec<&str> = rows.iter().filter(is_unmarked).map(|row| row.key.as_str()).collect();
            if let Some(first) = unmarked.first() {
                let explanations = count(unmarked.len(), "explanation");
                note(format_args!(
                    "warning: task {}: {explanations} not marked yet ({first}, …): these grades lack its points",
                    task.id
                ));
            }
        }
    }
}

/// Exit status of a class: 3 if the grader failed with a submission.
pub(super) fn exit_status(outcome: &Outcome) -> u8 {
    let has_failed = outcome.rows.iter().any(|row| row.kept || row.state == State::Harness);
    if has_failed { 3 } else { 0 }
}

/// Prints which scores changed.
pub(super) fn print_changes(outcome: &Outcome) -> Result<()> {
    print_line(format_args!("{} of {} scores changed", outcome.changes.len(), outcome.rows.len()))?;
    outcome.changes.iter().try_for_each(|change| print_line(format_args!("  {change}")))
}

/// Prints how many submissions were graded, and which scores changed.
fn print(outcome: &Outcome, similar: usize, with_changes: bool) -> Result<()> {
    if with_changes || !outcome.changes.is_empty() {
        print_changes(outcome)?;
    }
    let number = |fits: &dyn Fn(&Row) -> bool| outcome.rows.iter().filter(|row| fits(row)).count();
    let has_roster = outcome.rows.iter().any(|row| row.on_roster);
    print_line(format_args!(
        "{} graded now, {} unchanged, {} refused, {} missing, {} not on the roster, {} of similar submissions",
        outcome.graded,
        outcome.unchanged,
        number(&|row| row.state == State::Refused),
        number(&|row| row.state == State::Missing),
        number(&|row| has_roster && !row.on_roster),
        count(similar, "group"),
    ))?;
    let is_unknown = |row: &Row| row.lateness.as_ref().is_some_and(|late| late.standing == Standing::Unknown);
    let unknown = number(&is_unknown);
    if unknown > 0 {
        let submissions = count(unknown, "submission");
        note(format_args!("{submissions} without a receipt time: counted in full (see --manifest)"));
    }
    Ok(())
}

fn report_filled(system: &str, filled: &systems::Filled) {
    note(format_args!("{system}: {} filled in", count(filled.filled, "row")));
    for left in &filled.left {
        note(format_args!("  left unchanged: {left}"));
    }
}
