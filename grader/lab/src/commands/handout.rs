//! `cargo lab handout`.

use std::path::PathBuf;
use std::process::ExitCode;

use crate::handout;
use crate::output::print;
use harness::assignment::AssignmentOption;
use harness::workspace::Workspace;
use verdict::check::Visibility;
use verdict::error::Result;

/// Create the handout for students: the checkout without the solution or anything that reveals it
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The folder to create; it must be missing or empty
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    #[command(flatten)]
    assignment: AssignmentOption,
}

pub(super) fn run(arguments: &Arguments) -> Result<ExitCode> {
    let workspace = Workspace::find()?;
    let assignment = arguments.assignment.open(&workspace)?;
    let rubric = &assignment.rubric;
    let summary = handout::make(&workspace, &assignment, &arguments.out)?;
    let out = arguments.out.display();
    let (files, megabytes) = (summary.files, summary.bytes as f64 / 1e6);
    let staff = rubric.checks().filter(|(_, spec)| spec.visibility() == Visibility::StaffOnly).count();
    print(&format!(
        "{out}: {files} files, {megabytes:.1} MB\n\
         verified: no eight consecutive tokens that only the solution has are in it\n\
         staff-only checks, which a grade there skips: {staff}\n\
         try it: cd {out} && cargo grade\n"
    ))?;
    Ok(ExitCode::SUCCESS)
}
