//! `cargo lab gradescope`.

use std::path::PathBuf;
use std::process::ExitCode;

use crate::handout;
use crate::output::print;
use harness::assignment::AssignmentOption;
use harness::workspace::Workspace;
use verdict::error::Result;

/// Pack the grader for Gradescope as a zip archive with setup.sh and run_autograder, which contains the solution
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The archive to write
    #[arg(long, value_name = "FILE.zip", default_value = "autograder.zip")]
    out: PathBuf,
    #[command(flatten)]
    assignment: AssignmentOption,
}

pub(super) fn run(arguments: &Arguments) -> Result<ExitCode> {
    let workspace = Workspace::find()?;
    let bytes = handout::autograder(&workspace, &arguments.assignment.open(&workspace)?, &arguments.out)?;
    let (out, megabytes) = (arguments.out.display(), bytes as f64 / 1e6);
    print(&format!("{out}: {megabytes:.1} MB; contains the solution, for staff only\n"))?;
    Ok(ExitCode::SUCCESS)
}
