//! `grader __intake`: reads one submission for another grader, locked in.

#[cfg(target_os = "linux")]
mod lock;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use ::intake::{Reader, Wanted, serve};
use harness::assignment::Assignment;
use harness::workspace::Workspace;
use verdict::error::Result;
use verdict::report::Report;
use verdict::submission::Submission;

/// Read one submission for the grader that started this process
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Files, folders and archives of one student
    #[arg(required = true)]
    paths: Vec<PathBuf>,
    /// End of the path of the source
    #[arg(long, value_name = "PATH")]
    source: Option<String>,
}

/// Reads submissions in processes of this program. Where the program cannot be found, this process reads them.
pub(super) fn reader() -> Reader {
    // On Linux this is the program itself, also when its file was replaced while it runs.
    let link = Path::new("/proc/self/exe");
    if link.exists() {
        return Reader::Apart(link.to_owned());
    }
    std::env::current_exe().map_or(Reader::Here, Reader::Apart)
}

/// What is looked for in submissions of an assignment.
///
/// # Errors
/// If its starting file cannot be read.
pub(super) fn wanted(assignment: &Assignment) -> Result<Wanted> {
    Ok(Wanted::new(&assignment.rubric.submission, &assignment.folder.starter()?))
}

/// The source that a report is about; `None` if it cannot be read any more.
pub(super) fn source_of(report: &Report) -> Option<Submission> {
    let assignment = Assignment::open(&Workspace::find().ok()?, &report.provenance.assignment).ok()?;
    reader().read(report.submission.path.as_ref(), &wanted(&assignment).ok()?).ok()
}

pub(super) fn run(arguments: &Arguments) -> Result<ExitCode> {
    serve(&arguments.paths, arguments.source.as_deref(), || {
        // Elsewhere there is nothing to lock it in with.
        #[cfg(target_os = "linux")]
        lock::lock_in(&arguments.paths)?;
        Ok(())
    })?;
    Ok(ExitCode::SUCCESS)
}
