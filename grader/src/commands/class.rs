//! `grader class`.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use jiff::tz::TimeZone;

use super::min_sandbox::MinSandbox;
use super::policy::policy;
use classroom::class::gradebook::{Row, State, save_class, save_gradebook};
use classroom::class::page::ClassPage;
use classroom::class::{Class, RunOptions, has_results, roster, run, similar, systems};
use classroom::policy::{Manifest, Receipt, parse_received};
use harness::assignment::Assignment;
use harness::workspace::Workspace;
use judge::grade::Options;
use verdict::error::{Error, Result};

/// Grade a class: a folder of submissions as Moodle and ILIAS pack them, or one folder, archive or file for each student.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The folder of submissions
    folder: PathBuf,
    /// Who should have handed in (CSV) [default: the file of --moodle or --ilias]
    #[arg(long, value_name = "FILE.csv")]
    roster: Option<PathBuf>,
    /// When submissions came (CSV: student, received_at, md5, md5_received_at, path); file times are never used
    #[arg(long, value_name = "FILE.csv")]
    manifest: Option<PathBuf>,
    /// When all that the manifest does not name came
    #[arg(long, value_name = "TIME")]
    received_at: Option<String>,
    /// Deadline and extensions [default: course.yml beside the rubric, if there is one]
    #[arg(long, value_name = "FILE.yml")]
    course: Option<PathBuf>,
    /// Moodle's grading worksheet; a filled copy is written to --out
    #[arg(long, value_name = "FILE.csv")]
    moodle: Option<PathBuf>,
    /// The status.csv of an ILIAS exercise; a filled copy is written to --out
    #[arg(long, value_name = "FILE.csv")]
    ilias: Option<PathBuf>,
    #[command(flatten)]
    assignment: Assignment,
    /// Folder of the results
    #[arg(long, value_name = "DIR", default_value = "class-report")]
    out: PathBuf,
    /// How many submissions at once, each with one thread [default: one for each core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256))]
    jobs: Option<u16>,
    /// Go on where an earlier run ended: what has not changed is not graded again
    #[arg(long, conflicts_with = "regrade")]
    resume: bool,
    /// Grade everything again, and say what has changed
    #[arg(long)]
    regrade: bool,
    /// Leave out the pages of submissions and class, and the pictures on them
    #[arg(long)]
    no_report: bool,
    /// Seed of all random numbers: the same seed gives the same verdicts
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Run only these checks: by check, kind, scene, technique or task; may be given several times. Tasks of which not
    /// all checks are run have no points
    #[arg(long, value_name = "CHECK|SCENE|TASK", conflicts_with_all = ["moodle", "ilias"])]
    only: Vec<String>,
    #[command(flatten)]
    sandbox: MinSandbox,
}

pub(super) fn run_class(arguments: &Arguments) -> Result<ExitCode> {
    let workspace = Workspace::find()?;
    let out = &arguments.out;
    if has_results(out) && !(arguments.resume || arguments.regrade) {
        return Err(Error::file(
            out,
            "there are results of an earlier run: --resume keeps what has not changed, --regrade grades all again",
        ));
    }
    let rubric = arguments.assignment.rubric(&workspace)?;
    let policy = policy(&workspace, &arguments.assignment.name, &rubric, arguments.course.as_deref())?;
    let students = [&arguments.roster, &arguments.moodle, &arguments.ilias].into_iter().flatten().next();
    let students = students.map_or(Ok(Vec::new()), |path| roster::load(path))?;
    let mut class = Class::find(&arguments.folder, &students)?;
    let zone = policy.as_ref().map_or(TimeZone::UTC, |policy| policy.zone().clone());
    if let Some(path) = &arguments.manifest {
        class.receive(&Manifest::load(path, &zone)?)?;
    }
    if let Some(text) = &arguments.received_at {
        let time =
            parse_received(text, &zone).map_err(|error| Error::Input(format!("--received-at: {error}")))?;
        for member in class.members.iter_mut().filter(|member| member.receipts.is_empty()) {
            member.receipts.push(Receipt { received_at: Some(time), ..Receipt::default() });
        }
    }
    let folders = out.join("submissions");
    std::fs::create_dir_all(&folders).map_err(|error| Error::file(&folders, error))?;
    let options = RunOptions {
        grade: Options {
            assignment: arguments.assignment.name.clone(),
            seed: arguments.seed,
            threads: 1,
            only: arguments.only.clone(),
            limits: arguments.sandbox.of_others(),
        },
        jobs: arguments.jobs.map_or_else(rayon::current_num_threads, usize::from),
        out: out.clone(),
        regrade: arguments.regrade,
        pages: !arguments.no_report,
    };
    let tasks: Vec<String> = rubric.tasks.iter().map(|task| task.id.clone()).collect();
    let gradebook = out.join("gradebook.csv");
    eprintln!("{} in the class, {} at once", class.members.len(), options.jobs);
    let outcome =
        run(&workspace, &class, policy.as_ref(), &options, |rows| save_gradebook(&gradebook, rows, &tasks))?;

    let alike = similar::groups(&outcome.fingerprints);
    save_gradebook(&gradebook, &outcome.rows.iter().collect::<Vec<_>>(), &tasks)?;
    let automatic_max = rubric.tasks.iter().filter(|task| !task.manual).map(|task| task.points).sum();
    let provenance = &outcome.provenance;
    save_class(
        &out.join("class.json"),
        (&arguments.assignment.name, automatic_max),
        provenance,
        &outcome.rows,
        &alike,
    )?;
    let text = similar::describe(&alike);
    arty::image::write_aside(&out.join("similar.txt"), |file| {
        std::io::Write::write_all(file, text.as_bytes())
    })?;
    if !arguments.no_report {
        let page = ClassPage {
            rubric: &rubric,
            rows: &outcome.rows,
            changes: &outcome.changes,
            similar: alike.len(),
            out,
        };
        page.save(&out.join("class.html"))?;
    }
    if let Some(from) = &arguments.moodle {
        report_filled("Moodle", &systems::fill_moodle(from, &out.join("moodle.csv"), &outcome.rows)?);
    }
    if let Some(from) = &arguments.ilias {
        report_filled("ILIAS", &systems::fill_ilias(from, &out.join("status.csv"), &outcome.rows)?);
    }
    print_outcome(&outcome, &alike, &gradebook, arguments);
    let failed = outcome.rows.iter().any(|row| row.kept || row.state == State::Harness);
    Ok(ExitCode::from(if failed { 3 } else { 0 }))
}

fn report_filled(system: &str, filled: &systems::Filled) {
    eprintln!("{system}: {} rows filled in", filled.filled);
    for left in &filled.left {
        eprintln!("  left as it was: {left}");
    }
}

fn print_outcome(
    outcome: &classroom::class::Outcome,
    alike: &[similar::Group],
    gradebook: &Path,
    arguments: &Arguments,
) {
    if arguments.regrade || !outcome.changes.is_empty() {
        println!("{} of {} scores changed", outcome.changes.len(), outcome.rows.len());
        for change in &outcome.changes {
            println!("  {change}");
        }
    }
    let count = |fits: &dyn Fn(&Row) -> bool| outcome.rows.iter().filter(|row| fits(row)).count();
    println!(
        "{} graded now, {} unchanged, {} refused, {} missing, {} not on the roster, {} groups to look at",
        outcome.graded,
        outcome.unchanged,
        count(&|row| row.state == State::Refused),
        count(&|row| row.state == State::Missing),
        if arguments.roster.is_some() || arguments.moodle.is_some() || arguments.ilias.is_some() {
            count(&|row| !row.on_roster)
        } else {
            0
        },
        alike.len(),
    );
    let unknown = count(&|row| {
        row.lateness
            .as_ref()
            .is_some_and(|lateness| lateness.standing == classroom::policy::Standing::Unknown)
    });
    if unknown > 0 {
        eprintln!("of {unknown} submissions nobody said when they came: they count in full (see --manifest)");
    }
    if !arguments.only.is_empty() {
        eprintln!("note: with --only, sums are of those tasks alone whose checks were all run");
    }
    eprintln!("gradebook: {}", gradebook.display());
    if !arguments.no_report {
        eprintln!("page: {}", gradebook.with_file_name("class.html").display());
    }
}
