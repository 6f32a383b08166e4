//! `grader audit`.

use std::path::PathBuf;
use std::process::ExitCode;

use super::intake::wanted;
use harness::assignment::AssignmentOption;
use harness::build::compile;
use harness::sandbox::Limits;
use harness::workspace::Workspace;
use present::print_audit;
use verdict::error::{Error, Result};
use verdict::output;

/// Measure every factor of a submission's estimator in scripted scenes, without noise
///
/// Prints one row per factor: the exponent or value that it should have, and the one it has at the first, second and third
/// hit of a path; then one sentence for each that is wrong.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// A source file, or a folder with one in it [default: the student file of the assignment]
    submission: Option<PathBuf>,
    #[command(flatten)]
    assignment: AssignmentOption,
    /// Seed of the random numbers
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Also write the facts to this file as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

pub(super) fn run(arguments: &Arguments, workspace: &Workspace) -> Result<ExitCode> {
    let assignment = arguments.assignment.open(workspace)?;
    let path = arguments.submission.clone().unwrap_or_else(|| assignment.student_file());
    let submission = intake::read(&path, &wanted(&assignment)?)?;
    let program = compile(&assignment.framework(workspace)?, &submission.source, &Limits::default())?
        .map_err(|failure| Error::Input(format!("the submission does not compile:\n{}", failure.messages)))?;
    let audit = judge::audit::audit(&program, arguments.seed)?;
    if let Some(file) = &arguments.json {
        output::write_json(file, &audit)?;
    }
    print_audit(&audit);
    Ok(ExitCode::SUCCESS)
}
