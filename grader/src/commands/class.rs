//! `grader class`.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use jiff::tz::TimeZone;

use super::intake::reader;
use super::min_sandbox::MinSandbox;
use super::policy::policy;
use super::seed::Seed;
use classroom::class::gradebook::{Row, State, save_class, save_gradebook};
use classroom::class::page::ClassPage;
use classroom::class::{Class, Outcome, RunOptions, has_results, roster, run as grade_all, similar, systems};
use classroom::policy::{Manifest, Policy, Receipt, Standing, parse_received};
use harness::assignment::Assignment;
use harness::workspace::Workspace;
use judge::grade::Options;
use present::streams::{note, print_line};
use present::words::count;
use verdict::error::{Error, Result};
use verdict::output;
use verdict::rubric::Rubric;

/// Grade a class: a folder of submissions as exported by Moodle or ILIAS, or with one folder, archive or file per student
///
/// Applies deadlines and extensions, and writes a gradebook, an overview page, and the completed grade tables of course
/// systems.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Folder with the submissions
    folder: PathBuf,
    /// Class roster (CSV) [default: the file of --moodle or --ilias]
    #[arg(long, value_name = "FILE.csv")]
    roster: Option<PathBuf>,
    /// Receipt times (CSV: student, received_at, md5, md5_received_at, path); file times are never used
    #[arg(long, value_name = "FILE.csv")]
    manifest: Option<PathBuf>,
    /// Receipt time of submissions not listed in the manifest
    #[arg(long, value_name = "TIME")]
    received_at: Option<String>,
    /// Deadline and extensions [default: course.yml beside the rubric, if there is one]
    #[arg(long, value_name = "FILE.yml")]
    course: Option<PathBuf>,
    /// Moodle's grading worksheet; a completed copy is written to --out
    #[arg(long, value_name = "FILE.csv")]
    moodle: Option<PathBuf>,
    /// The status.csv of an ILIAS exercise; a completed copy is written to --out
    #[arg(long, value_name = "FILE.csv")]
    ilias: Option<PathBuf>,
    #[command(flatten)]
    assignment: Assignment,
    /// Folder for the results; created if missing
    #[arg(long, value_name = "DIR", default_value = "class-report")]
    out: PathBuf,
    /// Submissions to grade at once, each with one thread [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256))]
    jobs: Option<u16>,
    /// Resume an earlier run: grade only what has changed
    #[arg(long, conflicts_with = "regrade")]
    resume: bool,
    /// Grade everything again, and print which scores changed
    #[arg(long)]
    regrade: bool,
    /// Score only; skip the HTML pages and their images
    #[arg(long)]
    no_report: bool,
    #[command(flatten)]
    seed: Seed,
    /// Run only these checks, selected by name, kind, scene, technique or task; repeatable. A task earns points only
    /// if all of its checks are run
    #[arg(long, value_name = "CHECK|SCENE|TASK", conflicts_with_all = ["moodle", "ilias"])]
    only: Vec<String>,
    #[command(flatten)]
    sandbox: MinSandbox,
}

pub(super) fn run(arguments: &Arguments, workspace: &Workspace) -> Result<ExitCode> {
    let out = &arguments.out;
    if has_results(out) && !(arguments.resume || arguments.regrade) {
        return Err(Error::file(
            out,
            "there are results of an earlier run: --resume grades only what has changed, --regrade grades everything",
        ));
    }
    let rubric = arguments.assignment.rubric(workspace)?;
    let policy = policy(workspace, &arguments.assignment.name, &rubric, arguments.course.as_deref())?;
    let class = arguments.class(policy.as_ref())?;
    output::create_folder(&out.join("submissions"))?;
    let options = arguments.options()?;
    let tasks: Vec<String> = rubric.tasks.iter().map(|task| task.id.clone()).collect();
    let gradebook = out.join("gradebook.csv");
    note(format_args!("{} in the class, {} at once", class.members.len(), options.jobs));
    let outcome = grade_all(workspace, &class, policy.as_ref(), &options, |rows| {
        save_gradebook(&gradebook, rows, &tasks)
    })?;
    let similar = similar::groups(&outcome.fingerprints);
    arguments.print(&outcome, similar.len())?;
    save_gradebook(&gradebook, &outcome.rows.iter().collect::<Vec<_>>(), &tasks)?;
    arguments.save(&rubric, &outcome, &similar)?;
    let has_failed = outcome.rows.iter().any(|row| row.kept || row.state == State::Harness);
    Ok(ExitCode::from(if has_failed { 3 } else { 0 }))
}

impl Arguments {
    /// The members of the class with their submissions and receipt times.
    fn class(&self, policy: Option<&Policy>) -> Result<Class> {
        let students = self.students().map_or(Ok(Vec::new()), roster::load)?;
        let mut class = Class::find(&self.folder, &students)?;
        let zone = policy.map_or(TimeZone::UTC, |policy| policy.zone().clone());
        if let Some(path) = &self.manifest {
            class.receive(&Manifest::load(path, &zone)?)?;
        }
        if let Some(text) = &self.received_at {
            let time = parse_received(text, &zone)
                .map_err(|error| Error::Input(format!("--received-at: {error}")))?;
            for member in class.members.iter_mut().filter(|member| member.receipts.is_empty()) {
                member.receipts.push(Receipt { received_at: Some(time), ..Receipt::default() });
            }
        }
        Ok(class)
    }

    /// The file that names the students; `None` if none was given.
    fn students(&self) -> Option<&Path> {
        [&self.roster, &self.moodle, &self.ilias].into_iter().find_map(Option::as_deref)
    }

    fn options(&self) -> Result<RunOptions> {
        Ok(RunOptions {
            grade: Options {
                assignment: self.assignment.name.clone(),
                seed: self.seed.value()?,
                threads: 1,
                only: self.only.clone(),
                limits: self.sandbox.of_others(),
            },
            secret_seed: self.seed.is_secret(),
            jobs: self.jobs.map_or_else(rayon::current_num_threads, usize::from),
            out: self.out.clone(),
            regrade: self.regrade,
            pages: !self.no_report,
            reader: reader(),
        })
    }

    /// Writes class.json, similar.txt, the page, and the tables of course systems.
    fn save(&self, rubric: &Rubric, outcome: &Outcome, similar: &[similar::Group]) -> Result<()> {
        let out = &self.out;
        let automatic_max = rubric.tasks.iter().filter(|task| !task.manual).map(|task| task.points).sum();
        let assignment = (self.assignment.name.as_str(), automatic_max);
        save_class(&out.join("class.json"), assignment, &outcome.provenance, &outcome.rows, similar)?;
        output::write_bytes(&out.join("similar.txt"), similar::describe(similar))?;
        note(format_args!("gradebook: {}", out.join("gradebook.csv").display()));
        if !self.no_report {
            let (rows, changes) = (&outcome.rows, &outcome.changes);
            let page = ClassPage { rubric, rows, changes, similar: similar.len(), out };
            let file = out.join("class.html");
            page.save(&file)?;
            note(format_args!("page: {}", file.display()));
        }
        if let Some(from) = &self.moodle {
            report_filled("Moodle", &systems::fill_moodle(from, &out.join("moodle.csv"), &outcome.rows)?);
        }
        if let Some(from) = &self.ilias {
            report_filled("ILIAS", &systems::fill_ilias(from, &out.join("status.csv"), &outcome.rows)?);
        }
        Ok(())
    }

    /// Prints how many submissions were graded, and which scores changed.
    fn print(&self, outcome: &Outcome, similar: usize) -> Result<()> {
        if self.regrade || !outcome.changes.is_empty() {
            print_line(format_args!("{} of {} scores changed", outcome.changes.len(), outcome.rows.len()))?;
            for change in &outcome.changes {
                print_line(format_args!("  {change}"))?;
            }
        }
        let number = |fits: &dyn Fn(&Row) -> bool| outcome.rows.iter().filter(|row| fits(row)).count();
        let has_roster = self.students().is_some();
        print_line(format_args!(
            "{} graded now, {} unchanged, {} refused, {} missing, {} not on the roster, {} of similar submissions",
            outcome.graded,
            outcome.unchanged,
            number(&|row| row.state == State::Refused),
            number(&|row| row.state == State::Missing),
            number(&|row| has_roster && !row.on_roster),
            count(similar, "group"),
        ))?;
        let is_unknown =
            |row: &Row| row.lateness.as_ref().is_some_and(|late| late.standing == Standing::Unknown);
        let unknown = number(&is_unknown);
        if unknown > 0 {
            let submissions = count(unknown, "submission");
            note(format_args!("{submissions} without a receipt time: counted in full (see --manifest)"));
        }
        if !self.only.is_empty() {
            note("note: with --only, sums include only tasks whose checks were all run");
        }
        Ok(())
    }
}

fn report_filled(system: &str, filled: &systems::Filled) {
    note(format_args!("{system}: {} filled in", count(filled.filled, "row")));
    for left in &filled.left {
        note(format_args!("  left unchanged: {left}"));
    }
}
