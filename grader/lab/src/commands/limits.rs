//! `cargo lab limits`.

use std::path::PathBuf;
use std::process::ExitCode;

use crate::limits::Measurement;
use crate::output::{create_folder, print};
use harness::assignment::AssignmentOption;
use harness::workspace::Workspace;
use judge::extreme::measure::ExtremeSceneResult;
use judge::reference::Oracle;
use verdict::error::Result;

/// Measure the renderer's numerical range: renders every extreme scene and all sweeps, which takes some minutes
///
/// Exit status 1 if the framework renders an extreme scene incorrectly.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Run only this sweep, or only the extreme `scenes`; repeatable. The summary is printed instead of saved
    #[arg(long, value_name = "SWEEP")]
    only: Vec<String>,
    /// Folder for tables and plots [default: grader/lab/limits]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    assignment: AssignmentOption,
    /// Seed of all random numbers
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

const COMMAND: &str = "cargo lab limits";

pub(super) fn run(arguments: &Arguments) -> Result<ExitCode> {
    let workspace = Workspace::find()?;
    let measurement = Measurement::new(&arguments.only, arguments.seed)?;
    let folder = arguments.out.clone().unwrap_or_else(|| workspace.limits());
    create_folder(&folder)?;
    let program = Oracle::required(&workspace, &arguments.assignment.open(&workspace)?)?;
    let measured = measurement.run(&workspace, &program, &folder)?;
    if arguments.only.is_empty() {
        measured.save(&folder, COMMAND)?;
        eprintln!("tables and plots: {}", folder.display());
    } else {
        print(&measured.summary(COMMAND))?;
    }
    let wrong: Vec<&ExtremeSceneResult> =
        measured.findings.iter().filter(|finding| !finding.is_right()).collect();
    let line = |finding: &&ExtremeSceneResult| {
        format!("wrong: {} with {}\n", finding.scene, finding.settings.technique)
    };
    let lines: String = wrong.iter().map(line).collect();
    let scenes = measured.findings.len();
    print(&format!("{lines}{} of {scenes} extreme scenes are rendered correctly\n", scenes - wrong.len()))?;
    Ok(ExitCode::from(u8::from(!wrong.is_empty())))
}
