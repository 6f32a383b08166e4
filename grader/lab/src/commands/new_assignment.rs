//! `cargo lab new-assignment`.

use std::process::ExitCode;

use crate::new_assignment::create;
use crate::output::print;
use harness::assignment::AssignmentOption;
use harness::workspace::Workspace;
use verdict::error::Result;

/// Write the folder of a new assignment, which grades at once: one task, one check, one known mistake
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Name of the folder, such as 07-volumes
    name: String,
    /// Title of the exercise
    #[arg(long, default_value = "A new exercise")]
    title: String,
    #[command(flatten)]
    assignment: AssignmentOption,
}

pub(super) fn run(arguments: &Arguments) -> Result<ExitCode> {
    let workspace = Workspace::find()?;
    let file = arguments.assignment.open(&workspace)?.rubric.submission;
    let folder = create(&workspace, &arguments.name, &arguments.title, &file)?;
    let (name, folder) =
        (&arguments.name, folder.strip_prefix(workspace.root()).unwrap_or(&folder).display());
    print(&format!(
        "{folder}: it grades at once; assignments/README.md explains each file\n\
         try it: cargo grade {folder}/starter.rs --assignment={name}\n\
         \x20       cargo grade {folder}/solution.rs --assignment={name}\n\
         \x20       cargo lab mutants --assignment={name}\n"
    ))?;
    Ok(ExitCode::SUCCESS)
}
