//! `cargo lab handout`.

use std::path::PathBuf;
use std::process::ExitCode;

use crate::handout;
use harness::assignment::Assignment;
use harness::workspace::Workspace;
use verdict::check::Visibility;
use verdict::error::Result;

/// Make the folder that students get: the checkout without the solution and everything that reveals it
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The folder to create; it must be missing or empty
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    #[command(flatten)]
    assignment: Assignment,
}

pub(super) fn run(arguments: &Arguments) -> Result<ExitCode> {
    let workspace = Workspace::find()?;
    let rubric = arguments.assignment.rubric(&workspace)?;
    let summary = handout::make(&workspace, &arguments.assignment.name, &arguments.out)?;
    let out = arguments.out.display();
    println!("{out}: {} files, {:.1} MB", summary.files, summary.bytes as f64 / 1e6);
    println!("verified: no eight consecutive tokens of the solution's task blocks are in it");
    let staff = rubric.checks().filter(|(_, spec)| spec.visibility() == Visibility::StaffOnly).count();
    if staff > 0 {
        println!(
            "{staff} checks are run by staff only: a grade there skips them and says how many points they decide"
        );
    }
    println!("try it: cd {out} && cargo grade");
    Ok(ExitCode::SUCCESS)
}
