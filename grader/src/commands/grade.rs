//! `grader grade`.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use arty::image::check_writable;

use super::lateness::When;
use super::min_sandbox::MinSandbox;
use super::{export, full_report, watch};
use classroom::marks::Marks;
use harness::assignment::Assignment;
use harness::build::Framework;
use harness::workspace::Workspace;
use intake::{self, Intake, Refusal};
use judge::grade::{Grader, Options};
use present::export::Export;
use present::page::remove_pages;
use present::{Progress, print_profile, print_sum, print_summary};
use verdict::error::{Error, Result};
use verdict::submission::IntakeFinding;

/// Grade one submission.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// A render_pt.rs, or a folder, .zip, .tar.gz or git repository with one in it [default: the student file in the skeleton]
    submission: Option<PathBuf>,
    #[command(flatten)]
    assignment: Assignment,
    /// Folder for report.json, report.html (to hand out) and report-tutor.html; it is made if it is not there
    #[arg(long, value_name = "DIR", default_value = "report")]
    out: PathBuf,
    /// Seed of all random numbers: the same seed gives the same verdicts
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Run only these checks: by check, kind, scene, technique or task; may be given several times
    #[arg(long, value_name = "CHECK|SCENE|TASK")]
    only: Vec<String>,
    /// Threads for the submission [default: one for each core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256))]
    jobs: Option<u16>,
    /// A submission without a render_pt.rs gets a report with 0 points, where it is an error otherwise: for servers
    #[arg(long)]
    missing_is_zero: bool,
    /// Exit with status 1 if fewer points than this are earned, of all automatic points
    #[arg(long, value_name = "POINTS", conflicts_with = "only", value_parser = points)]
    fail_under: Option<f64>,
    /// Give the points only: leave out what follows them, error against run time and pages (also left out with --only)
    #[arg(long)]
    no_report: bool,
    /// Write the report in another format, too: markdown, junit, github, gradescope, classroom50, autolab; a file may
    /// follow (`-` is standard output); may be given several times
    #[arg(long, value_name = "FORMAT[:FILE]", conflicts_with = "watch")]
    export: Vec<Export>,
    /// Say where the time until the points went
    #[arg(long, conflicts_with_all = ["quiet", "watch"])]
    profile: bool,
    /// Print nothing but the sum of points; files are written all the same
    #[arg(long, short, conflicts_with = "watch")]
    quiet: bool,
    /// Grade again on every save, and show one short table; Ctrl-C ends it
    #[arg(long, conflicts_with = "fail_under")]
    watch: bool,
    #[command(flatten)]
    sandbox: MinSandbox,
    #[command(flatten)]
    when: When,
}

pub(super) fn run(arguments: &Arguments) -> Result<ExitCode> {
    let workspace = Workspace::find()?;
    let path = arguments.submission.clone().unwrap_or_else(|| workspace.student_file());
    let path = relative(path);
    let received = arguments.when.read(&workspace, &arguments.assignment.name)?;
    let Intake { outcome, notes, checksums, explanations } =
        take(&workspace, &path, arguments.missing_is_zero)?;
    let threads = arguments.jobs.map_or_else(rayon::current_num_threads, usize::from);
    let options = Options {
        assignment: arguments.assignment.name.clone(),
        seed: arguments.seed,
        threads,
        only: arguments.only.clone(),
        limits: arguments.sandbox.of_one(),
    };
    let file = arguments.out.join("report.json");
    std::fs::create_dir_all(&arguments.out).map_err(|error| Error::file(&arguments.out, error))?;
    check_writable(&file)?;
    remove_pages(&file)?;
    for export in &arguments.export {
        export.target(&arguments.out).map_or(Ok(()), |file| check_writable(&file))?;
    }
    let mut progress = if arguments.quiet { Progress::hidden() } else { Progress::new() };
    if Framework::is_first(&workspace) {
        progress
            .say("building the framework that submissions are linked against: once, and it takes a minute …");
    }
    if arguments.watch {
        watch::watch(&workspace, &path, &options, &file)?;
    }
    for note in &notes {
        progress.say(&format!("note: {note}"));
    }
    progress.begin("making the framework ready");
    let grader = Grader::new(&workspace, &options)?;
    progress.expect(grader.planned());
    let (mut report, program) = match outcome {
        Ok(submission) => grader.grade_and_keep(&submission, |check| progress.ended(check))?,
        Err(refusal) => (grader.refuse(&path, &(&refusal).into())?, None),
    };
    progress.finish();
    report.submission.notes = notes.iter().map(IntakeFinding::from).collect();
    report.submission.explanations = explanations;
    Marks::open(&arguments.out)?.apply(&mut report);
    report.save(&file)?;
    if arguments.quiet {
        print_sum(&report);
    } else {
        print_summary(&report);
    }
    if let Some(received) = &received {
        println!("{}", received.describe(report.points.earned, &checksums));
    }
    if arguments.profile {
        print_profile(&report);
    }
    export::after_grade(&report, &arguments.export, &arguments.out)?;
    if !arguments.no_report && arguments.only.is_empty() {
        let completed = full_report::complete(&workspace, &grader, program.as_ref(), &mut report, &file);
        if let Err(error) = completed {
            // The points stand and are saved: whoever waits for them must not be told that grading failed.
            eprintln!("warning: the report is not complete: {error}");
        }
    }
    if !arguments.quiet {
        eprintln!("report: {}", file.display());
    }
    export::at_the_end(&report, &arguments.export, &arguments.out)?;
    let too_few = arguments.fail_under.is_some_and(|least| report.points.earned < least);
    Ok(ExitCode::from(u8::from(too_few)))
}

/// Takes in what was named. That nothing at all is there, or that it cannot be read, is the fault of whoever named it;
/// any other refusal is that of the submission, which has no points then. So are these with `missing_is_zero`.
fn take(workspace: &Workspace, path: &Path, missing_is_zero: bool) -> Result<Intake> {
    let starter = std::fs::read_to_string(workspace.student_file()).unwrap_or_default();
    let intake = intake::take(&[path.to_owned()], &starter)?;
    match &intake.outcome {
        Err(refusal @ (Refusal::MissingFile(_) | Refusal::Unreadable(..))) if !missing_is_zero => {
            Err(Error::file(path, refusal))
        }
        _ => Ok(intake),
    }
}

fn points(text: &str) -> std::result::Result<f64, String> {
    let points: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    if points.is_finite() { Ok(points) } else { Err("not a number of points".to_owned()) }
}

/// The path as a person in the current folder would write it.
fn relative(path: PathBuf) -> PathBuf {
    let current = std::env::current_dir().ok();
    current.and_then(|folder| path.strip_prefix(folder).map(PathBuf::from).ok()).unwrap_or(path)
}
