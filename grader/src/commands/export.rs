//! `grader export`: a report in the format of another system, and what a grade exports by itself.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use super::intake::source_of;
use present::export::{Export, Format, Received, Surroundings};
use present::streams::{note, print};
use verdict::error::{Error, Result};
use verdict::report::Report;

/// Write a report in the format of another system: Markdown, JUnit, GitHub, Gradescope, Classroom 50, Autolab
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The report.json of a grade
    report: PathBuf,
    /// Format to write
    #[arg(long)]
    format: Format,
    /// File to write [default: standard output]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Gradescope's submission_metadata.json, to report how late the submission is
    #[arg(long, value_name = "FILE")]
    metadata: Option<PathBuf>,
}

pub(super) fn run(arguments: &Arguments) -> Result<ExitCode> {
    let report = Report::load(&arguments.report)?;
    let mut surroundings = surroundings_of(&report);
    surroundings.received = arguments.metadata.as_deref().map(Received::load).transpose()?;
    let file = arguments.out.clone().unwrap_or_else(|| PathBuf::from("-"));
    Export { format: arguments.format, file: Some(file) }.write(&report, &surroundings, Path::new("."))?;
    Ok(ExitCode::SUCCESS)
}

/// Writes the files that `--export` asks for, and on GitHub Actions a step summary and annotations.
///
/// # Errors
/// If a file cannot be written.
pub(super) fn after_grade(report: &Report, exports: &[Export], folder: &Path) -> Result<()> {
    let surroundings = surroundings_of(report);
    let variable = |name: &str| surroundings.environment.get(name).filter(|value| !value.is_empty());
    if let Some(file) = variable("GITHUB_STEP_SUMMARY") {
        append(Path::new(file), &Format::Markdown.render(report, &surroundings)?)?;
        note("GITHUB_STEP_SUMMARY is set: a summary was added to it");
    }
    let is_asked_for = exports.iter().any(|export| export.format == Format::Github);
    if variable("GITHUB_ACTIONS").is_some_and(|value| value == "true") && !is_asked_for {
        print(Format::Github.render(report, &surroundings)?)?;
        note("GITHUB_ACTIONS is set: annotations were printed");
    }
    let mut files = exports.iter().filter(|export| export.target(folder).is_some());
    files.try_for_each(|export| export.write(report, &surroundings, folder))
}

/// Writes the formats that `--export` sends to standard output, after everything else: Autolab reads the last line.
///
/// # Errors
/// If standard output cannot be written.
pub(super) fn at_the_end(report: &Report, exports: &[Export], folder: &Path) -> Result<()> {
    let surroundings = surroundings_of(report);
    let mut others = exports.iter().filter(|export| export.target(folder).is_none());
    others.try_for_each(|export| export.write(report, &surroundings, folder))
}

/// Adds a text to a file, which may hold the summaries of other steps.
fn append(path: &Path, text: &str) -> Result<()> {
    let file = std::fs::OpenOptions::new().create(true).append(true).open(path);
    file.and_then(|mut file| file.write_all(text.as_bytes())).map_err(|error| Error::output(path, error))
}

/// What the formats need to know beside the report: the environment, and the lines of its tasks if its source is still
/// there.
fn surroundings_of(report: &Report) -> Surroundings {
    Surroundings::here(report, source_of(report).as_ref())
}
