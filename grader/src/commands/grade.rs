//! `grader grade`.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use super::intake::{reader, wanted};
use super::lateness::{Received, When};
use super::min_sandbox::MinSandbox;
use super::seed::Seed;
use super::{export, full_report, watch};
use ::intake::{Intake, Refusal, Wanted};
use classroom::marks::Marks;
use harness::assignment::AssignmentOption;
use harness::build::{Framework, SubmissionProgram};
use harness::workspace::Workspace;
use judge::grade::{Grader, Options};
use present::export::Export;
use present::page::remove_pages;
use present::streams::{note, print_line};
use present::{Detail, Progress, print_profile, print_sum, print_summary};
use verdict::error::{Error, Result};
use verdict::output;
use verdict::report::Report;
use verdict::submission::IntakeFinding;

/// Grade one submission: build it, run the checks, print the points and write report.json
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// A source file, or a folder, .zip, .tar.gz or git repository with one in it [default: the student file of the assignment]
    submission: Option<PathBuf>,
    /// Source to grade if there are several: the end of its path, in archives too
    #[arg(long, value_name = "PATH", conflicts_with = "watch")]
    source: Option<String>,
    #[command(flatten)]
    assignment: AssignmentOption,
    /// Folder for report.json, report.html (for the student) and report-tutor.html; created if missing
    #[arg(long, value_name = "DIR", default_value = "report")]
    out: PathBuf,
    #[command(flatten)]
    seed: Seed,
    /// Run only these checks, selected by name, kind, scene, technique or task; repeatable
    #[arg(long, value_name = "CHECK|SCENE|TASK")]
    only: Vec<String>,
    /// Number of threads for the submission [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256))]
    jobs: Option<u16>,
    /// Report 0 points for a submission without a source file instead of failing (for servers)
    #[arg(long)]
    missing_is_zero: bool,
    /// Exit with status 1 if automatic grading gives fewer points than this
    #[arg(long, value_name = "POINTS", conflicts_with = "only", value_parser = points)]
    fail_under: Option<f64>,
    /// Score only; skip convergence and HTML (implied by --only)
    #[arg(long)]
    no_report: bool,
    /// Also write the report as markdown, junit, github, gradescope, classroom50 or autolab, to a file if one is given
    /// (`-` is standard output); repeatable
    #[arg(long, value_name = "FORMAT[:FILE]", conflicts_with = "watch")]
    export: Vec<Export>,
    /// Print every task with its failed checks, all likely causes and all remarks, not only the next step
    #[arg(long, conflicts_with_all = ["quiet", "watch"])]
    all: bool,
    /// Print how much time each step and each check took
    #[arg(long, conflicts_with_all = ["quiet", "watch"])]
    profile: bool,
    /// Print only the total points; all files are still written
    #[arg(long, short, conflicts_with = "watch")]
    quiet: bool,
    /// Grade again on every save and show a short table; stop with Ctrl-C
    #[arg(long, conflicts_with = "fail_under")]
    watch: bool,
    #[command(flatten)]
    sandbox: MinSandbox,
    #[command(flatten)]
    when: When,
}

pub(super) fn run(arguments: &Arguments, workspace: &Workspace) -> Result<ExitCode> {
    let assignment = arguments.assignment.open(workspace)?;
    let options = arguments.options(&assignment.name)?;
    let path = relative(arguments.submission.clone().unwrap_or_else(|| assignment.student_file()));
    let received = arguments.when.read(&assignment)?;
    let wanted = wanted(&assignment)?;
    let intake = arguments.take(&wanted, &path)?;
    let file = arguments.out.join("report.json");
    prepare(arguments, &file)?;
    let marks = Marks::open(&arguments.out)?;
    let mut progress = match arguments.detail() {
        _ if arguments.quiet => Progress::hidden(),
        Detail::Next => Progress::without_checks(),
        Detail::All => Progress::new(),
    };
    if Framework::is_first(workspace) {
        progress.say("building the framework that submissions are linked against: once, takes a minute …");
    }
    if arguments.watch {
        watch::watch(workspace, &path, &wanted, &options, &file)?;
    }
    for note in &intake.notes {
        progress.say(&format!("note: {note}"));
    }
    progress.begin("preparing the framework");
    let grader = Grader::new(workspace, &options)?;
    let grader = if arguments.seed.is_secret() { grader.with_secret_seed() } else { grader };
    let checksums = intake.checksums.clone();
    let (mut report, program) = grade(&grader, intake, &path, &mut progress)?;
    let student = report.submission.path.clone();
    marks.apply(&mut report, &student);

    // Whatever fails from here on, the points have been printed.
    print_points(arguments, &report, received.as_ref(), &checksums)?;
    report.save(&file)?;
    export::after_grade(&report, &arguments.export, &arguments.out)?;
    let mut completed = Ok(());
    if !arguments.no_report && arguments.only.is_empty() {
        completed = full_report::complete(workspace, &grader, program.as_ref(), &mut report, &file);
        if let Err(error) = &completed {
            note(format_args!("warning: the report is incomplete: {error}"));
        }
    }
    if !arguments.quiet {
        note(format_args!("report: {}", file.display()));
    }
    export::at_the_end(&report, &arguments.export, &arguments.out)?;
    // After any other error the points are valid and saved: a script must not be told that grading failed.
    if let Err(error @ Error::Output(_)) = completed {
        return Err(error);
    }
    let too_few = arguments.fail_under.is_some_and(|min| report.points.earned < min);
    Ok(ExitCode::from(u8::from(too_few)))
}

impl Arguments {
    /// Takes in the submission at `path`.
    ///
    /// # Errors
    /// If nothing is there or it cannot be read, unless that means 0 points (`--missing-is-zero`), and if `--source` names
    /// nothing. Any other refusal is a fault of the submission, which then has 0 points.
    fn take(&self, wanted: &Wanted, path: &Path) -> Result<Intake> {
        let intake = reader().take(&[path.to_owned()], wanted, self.source.as_deref())?;
        match &intake.outcome {
            Err(refusal @ (Refusal::MissingFile(..) | Refusal::Unreadable(..))) if !self.missing_is_zero => {
                Err(Error::file(path, refusal))
            }
            Err(refusal @ Refusal::NotThere(..)) => Err(Error::file(path, refusal)),
            _ => Ok(intake),
        }
    }

    fn detail(&self) -> Detail {
        if self.all { Detail::All } else { Detail::Next }
    }

    fn options(&self, assignment: &str) -> Result<Options> {
        Ok(Options {
            assignment: assignment.to_owned(),
            seed: self.seed.value()?,
            threads: self.jobs.map_or_else(rayon::current_num_threads, usize::from),
            only: self.only.clone(),
            limits: self.sandbox.of_one(),
        })
    }
}

/// Finds out whether all results can be written, and removes the pages of an earlier grade.
fn prepare(arguments: &Arguments, file: &Path) -> Result<()> {
    output::create_folder(&arguments.out)?;
    output::check_writable(file)?;
    for export in &arguments.export {
        export.target(&arguments.out).map_or(Ok(()), |file| output::check_writable(&file))?;
    }
    remove_pages(file)
}

/// Grades what was taken in. The program is `None` if nothing compiled.
fn grade(
    grader: &Grader,
    intake: Intake,
    path: &Path,
    progress: &mut Progress,
) -> Result<(Report, Option<SubmissionProgram>)> {
    progress.expect(grader.planned());
    let (mut report, program) = match intake.outcome {
        Ok(submission) => grader.grade_and_keep(&submission, |check| progress.ended(check))?,
        Err(refusal) => (grader.refuse(path, &(&refusal).into())?, None),
    };
    progress.finish();
    report.submission.notes = intake.notes.iter().map(IntakeFinding::from).collect();
    report.submission.explanations = intake.explanations;
    Ok((report, program))
}

fn print_points(
    arguments: &Arguments,
    report: &Report,
    received: Option<&Received>,
    checksums: &[String],
) -> Result<()> {
    if arguments.quiet {
        print_sum(report);
    } else {
        print_summary(report, arguments.detail());
    }
    if let Some(received) = received {
        print_line(received.describe(report.points.earned, checksums))?;
    }
    if arguments.profile {
        print_profile(report);
    }
    Ok(())
}

fn points(text: &str) -> std::result::Result<f64, String> {
    let points: Option<f64> = text.parse().ok();
    points.filter(|points| points.is_finite()).ok_or_else(|| "not a number of points".to_owned())
}

/// The path relative to the current folder if it is below it.
fn relative(path: PathBuf) -> PathBuf {
    let current = std::env::current_dir().ok();
    current.and_then(|folder| path.strip_prefix(folder).map(PathBuf::from).ok()).unwrap_or(path)
}
