//! `cargo lab coverage`.

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::{Duration, Instant};

use crate::coverage::{Experiment, Records, table};
use crate::output::write_text;
use harness::assignment::AssignmentOption;
use harness::workspace::Workspace;
use verdict::error::Result;

/// Measure how often the intervals of convergence measurements hold the truth
///
/// Compares the solution with itself, and with programs that differ from it in a known way.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Number of comparisons of the solution with itself, over all scenes, half of them under load
    #[arg(long, value_name = "N", default_value_t = 480)]
    comparisons: u64,
    /// Number of comparisons with each program that differs
    #[arg(long, value_name = "N", default_value_t = 20)]
    planted: u64,
    /// Processor time of one comparison in seconds; programs that differ get four times as much
    #[arg(long, default_value_t = 1.2)]
    seconds: f64,
    /// Number of busy threads beside every other comparison
    #[arg(long, value_name = "N", default_value_t = 8)]
    load: usize,
    /// Stop after this many minutes; the next run resumes
    #[arg(long, value_name = "MINUTES")]
    minutes: Option<f64>,
    #[command(flatten)]
    assignment: AssignmentOption,
    /// Folder for the results; existing results are reused [default: target/coverage]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub(super) fn run(arguments: &Arguments) -> Result<ExitCode> {
    let workspace = Workspace::find()?;
    let assignment = arguments.assignment.open(&workspace)?;
    let Arguments { comparisons, planted, seconds, load, .. } = *arguments;
    let folder = arguments.out.clone().unwrap_or_else(|| workspace.root().join("target").join("coverage"));
    let mut records = Records::open(&folder)?;
    let after = |minutes: f64| Instant::now() + Duration::from_secs_f64(60.0 * minutes.max(0.0));
    let deadline = arguments.minutes.map(after);
    Experiment {
        workspace: &workspace,
        assignment: &assignment,
        comparisons,
        planted,
        seconds,
        load,
        deadline,
    }
    .run(&mut records)?;
    let command = format!(
        "cargo lab coverage --comparisons={comparisons} --planted={planted} --seconds={seconds} --load={load}"
    );
    let path = assignment.folder.coverage_table();
    write_text(&path, &table(&records.current(), &command))?;
    eprintln!("table: {}", path.display());
    Ok(ExitCode::SUCCESS)
}
