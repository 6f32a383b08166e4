//! `cargo lab handout`.

use std::path::PathBuf;
use std::process::ExitCode;

use crate::handout;
use harness::assignment::Assignment;
use harness::workspace::Workspace;
use verdict::error::Result;
use verdict::rubric::CheckKind;

/// Make the folder that students get: everything but the solution and what would give it away (for staff).
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The folder to write; it must not be there yet, or be empty
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
    println!("no eight tokens in a row of the solution's task blocks are in it");
    let staff = rubric.checks().filter(|(_, spec)| spec.check == CheckKind::HiddenVariants).count();
    if staff > 0 {
        println!(
            "{staff} checks need the solution: a grade there leaves them out and says what they are worth"
        );
    }
    println!("try it: cd {out} && cargo grade");
    Ok(ExitCode::SUCCESS)
}
