//! `grader export`: a report in the format of another system, and what a grade exports by itself.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use present::export::{Export, Format, Received, Surroundings};
use verdict::error::{Error, Result};
use verdict::report::Report;

/// Write a report in the format of another system: Markdown, JUnit, GitHub, Gradescope, Classroom 50, Autolab.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The report.json of a grade
    report: PathBuf,
    /// The format
    #[arg(long)]
    format: Format,
    /// The file to write; standard output without it
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Gradescope's submission_metadata.json, to say how late a submission is
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

/// Writes the files that were asked for with `--export`, and what GitHub's machines show if it is there.
///
/// # Errors
/// If a file cannot be written.
pub(super) fn after_grade(report: &Report, exports: &[Export], folder: &Path) -> Result<()> {
    let surroundings = surroundings_of(report);
    let variable = |name: &str| surroundings.environment.get(name).filter(|value| !value.is_empty());
    if let Some(file) = variable("GITHUB_STEP_SUMMARY") {
        // Other steps' summaries may stand there already.
        let path = Path::new(file);
        let summary = Format::Markdown.render(report, &surroundings)?;
        std::fs::OpenOptions::new()
            .create(true)
            .append(true)
            .open(path)
            .and_then(|mut file| file.write_all(summary.as_bytes()))
            .map_err(|error| Error::file(path, error))?;
        eprintln!("GITHUB_STEP_SUMMARY is set: a summary was added to it");
    }
    let asked_for = exports.iter().any(|export| export.format == Format::Github);
    if variable("GITHUB_ACTIONS").is_some_and(|value| value == "true") && !asked_for {
        Export { format: Format::Github, file: None }.write(report, &surroundings, folder)?;
        eprintln!("GITHUB_ACTIONS is set: annotations were printed");
    }
    let mut files = exports.iter().filter(|export| export.target(folder).is_some());
    files.try_for_each(|export| export.write(report, &surroundings, folder))
}

/// Writes what was asked for on standard output, after everything else: Autolab reads the last line.
///
/// # Errors
/// If it cannot be written.
pub(super) fn at_the_end(report: &Report, exports: &[Export], folder: &Path) -> Result<()> {
    let surroundings = surroundings_of(report);
    let mut others = exports.iter().filter(|export| export.target(folder).is_none());
    others.try_for_each(|export| export.write(report, &surroundings, folder))
}

/// Where a report is exported, with the lines of its tasks if its source is still there.
fn surroundings_of(report: &Report) -> Surroundings {
    Surroundings::here(report, intake::read(report.submission.path.as_ref()).ok().as_ref())
}
