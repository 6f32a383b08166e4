//! `grader merge`.

use std::path::PathBuf;
use std::process::ExitCode;

use super::class_tables::{Systems, Tables, exit_status};
use classroom::class::{merge, shard};
use classroom::lock::FolderLock;
use harness::assignment::AssignmentOption;
use harness::workspace::Workspace;
use present::streams::note;
use verdict::error::Result;
use verdict::output;

/// Merge the shards of a class that several machines have graded, and write its tables
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Folders of the shards [default: all shards in --out]
    shards: Vec<PathBuf>,
    #[command(flatten)]
    systems: Systems,
    #[command(flatten)]
    assignment: AssignmentOption,
    /// Folder for the results of the class; marks of tutors are stored there
    #[arg(long, value_name = "DIR", default_value = "class-report")]
    out: PathBuf,
    /// Skip the page of the class
    #[arg(long)]
    no_report: bool,
}

pub(super) fn run(arguments: &Arguments, workspace: &Workspace) -> Result<ExitCode> {
    let out = &arguments.out;
    arguments.systems.check()?;
    let assignment = arguments.assignment.open(workspace)?;
    let rubric = &assignment.rubric;
    let folders = if arguments.shards.is_empty() { shard::folders(out)? } else { arguments.shards.clone() };
    output::create_folder(out)?;
    let _lock = FolderLock::of_results(out)?;
    let outcome = merge(&folders, out, rubric)?;
    let tables = Tables { systems: &arguments.systems, rubric, out, page: !arguments.no_report };
    tables.save(&outcome, false)?;
    if let Some(level) = outcome.weakest_sandbox {
        note(format_args!("sandbox: {level} in the weakest of {} shards", folders.len()));
    }
    Ok(ExitCode::from(exit_status(&outcome)))
}
