//! `cargo lab calibrate`.

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::{Duration, Instant};

use crate::calibration::{Effort, Experiment, Results};
use crate::mutants::{Kind, Ledger, Variant, hash_of_inputs, variants};
use crate::output::write_text;
use harness::assignment::AssignmentOption;
use harness::workspace::Workspace;
use verdict::error::Result;

/// Measure the false-alarm rate and the smallest detectable bias
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Number of simulated grades, resampled from recorded images of the correct variants in turn
    #[arg(long, value_name = "N", default_value_t = 30_000)]
    resampled: u64,
    /// Number of simulated grades of the solution at each bias
    #[arg(long, value_name = "N", default_value_t = 200)]
    power: u64,
    /// Number of simulated grades for the comparison with simpler tests: of each wrong variant in each check of the
    /// tasks it fails, and as many without an error; 0 skips the comparison
    #[arg(long, value_name = "N", default_value_t = 20)]
    rivals: u64,
    /// Number of complete grades, of the correct variants in turn
    #[arg(long, value_name = "N", default_value_t = 1000)]
    grades: u64,
    /// Number of images with one sample per pixel to record for each check
    #[arg(long, value_name = "N", default_value_t = 8192)]
    pool: u64,
    /// Stop after this many minutes; the next run resumes
    #[arg(long, value_name = "MINUTES")]
    minutes: Option<f64>,
    #[command(flatten)]
    assignment: AssignmentOption,
    /// Folder for the results; existing results are reused [default: target/calibration, and target/mutants for complete
    /// grades]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Number of threads [default: one per core]
    #[arg(long, value_name = "N")]
    jobs: Option<usize>,
}

pub(super) fn run(arguments: &Arguments) -> Result<ExitCode> {
    let workspace = Workspace::find()?;
    let assignment = arguments.assignment.open(&workspace)?;
    let (folder_of_assignment, name) = (&assignment.folder, assignment.name.as_str());
    let (right, wrong): (Vec<Variant>, Vec<Variant>) =
        variants(&assignment)?.list.into_iter().partition(|variant| variant.kind == Kind::Right);
    let folder =
        |name: &str| arguments.out.clone().unwrap_or_else(|| workspace.root().join("target").join(name));
    let Arguments { resampled, power, rivals, grades, pool, minutes, jobs, .. } = *arguments;
    let mut experiment = Experiment {
        effort: Effort { resampled, power, rivals, grades, pool },
        workspace: &workspace,
        assignment: name,
        rubric: &assignment.rubric,
        right: &right,
        wrong: &wrong,
        framework: assignment.framework(&workspace)?,
        base: hash_of_inputs(&workspace, name)?,
        threads: jobs.unwrap_or_else(rayon::current_num_threads).max(1),
        results: Results::open(&folder("calibration"))?,
        ledger: Ledger::open(&folder("mutants"), &workspace, name)?,
        deadline: minutes.map(|minutes| Instant::now() + Duration::from_secs_f64(60.0 * minutes.max(0.0))),
    };
    experiment.run()?;
    let (tables, plot) = experiment.summary();
    write_text(&folder_of_assignment.calibration_table(), &tables)?;
    eprintln!("tables: {}", folder_of_assignment.calibration_table().display());
    if let Some(plot) = plot {
        write_text(&folder_of_assignment.calibration_plot(), &plot)?;
        eprintln!("plot: {}", folder_of_assignment.calibration_plot().display());
    }
    Ok(ExitCode::SUCCESS)
}
