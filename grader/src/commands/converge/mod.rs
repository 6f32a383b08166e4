//! `grader converge`.

mod external;
mod programs;

use std::path::PathBuf;
use std::process::ExitCode;

use arty::integrator::Technique;
use indicatif::{ProgressBar, ProgressStyle};

use external::External;
use harness::assignment::AssignmentOption;
use harness::workspace::Workspace;
use judge::convergence::{MeasuredProgram, Options, crops, measure};
use present::convergence::{Axis, page, print_table, save_csv, save_json, svg};
use present::streams::note;
use programs::Programs;
use verdict::convergence::{Convergence, DEFAULT_SCENES};
use verdict::error::Result;
use verdict::output;
use verdict::rubric::Rubric;

/// Measure the error of submissions against run time, in comparison with the solution and plain BSDF sampling
///
/// Each point on a curve comes from many independent renderings of the same length, measured in processor time;
/// programs take turns. Errors are relative MSEs against the stored references, whose own noise is subtracted. The
/// curve of an unbiased program falls with slope −1; a curve that flattens indicates a bias. With --against, efficiencies
/// are relative to the first program given there, otherwise to the solution. Writes convergence.svg, .csv and .json, and
/// convergence.html with plots over time, samples and rays, and crops at equal time.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Submissions, each a source file or a folder with one in it [default: the student file of the assignment]
    submissions: Vec<PathBuf>,
    #[command(flatten)]
    assignment: AssignmentOption,
    /// Compare with another submission, or with a .csv of measurements from elsewhere (columns scene, seconds, relative_mse;
    /// optionally technique and program); repeatable
    #[arg(long, value_name = "OTHER")]
    against: Vec<PathBuf>,
    /// Scene by name; repeatable [default: cornell_box, cornell_box_glossy, veach_mis, many_lights]
    #[arg(long, value_name = "SCENE")]
    scene: Vec<String>,
    /// Technique; repeatable [default: those that students write]
    #[arg(long, value_name = "TECHNIQUE")]
    technique: Vec<Technique>,
    /// Total processor time in seconds
    #[arg(long, default_value_t = 60.0, value_parser = above_zero)]
    seconds: f64,
    /// Report the time needed to reach this relMSE [default: the solution's, halfway through]
    #[arg(long, value_name = "ERROR", value_parser = above_zero)]
    error: Option<f64>,
    /// Seed of all random numbers
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Number of threads per program; with more than one, processor times are less accurate
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=256))]
    jobs: u16,
    /// Folder for the results; created if missing
    #[arg(long, value_name = "DIR", default_value = "convergence")]
    out: PathBuf,
}

/// Lengths of renderings, from the shortest to the longest.
const LENGTHS: u32 = 6;

pub(super) fn run(arguments: &Arguments, workspace: &Workspace) -> Result<ExitCode> {
    output::create_folder(&arguments.out)?;
    for extension in ["svg", "csv", "json", "html"] {
        output::check_writable(&arguments.file(extension))?;
    }
    let is_table = |path: &&PathBuf| path.extension().is_some_and(|extension| extension == "csv");
    let (tables, rivals): (Vec<&PathBuf>, Vec<&PathBuf>) = arguments.against.iter().partition(is_table);
    let external = tables.into_iter().map(|path| External::load(path)).collect::<Result<Vec<_>>>()?;
    let assignment = arguments.assignment.open(workspace)?;
    let options = arguments.options(&assignment.rubric);
    external.iter().try_for_each(|external| external.check(&options.scenes))?;
    let programs = Programs::build(&arguments.submissions, &rivals, workspace, &assignment)?;
    let measured = programs.measured();
    let progress = progress_bar();
    let mut convergence =
        measure(workspace, &measured, &options, |done| progress.set_position((done * STEPS as f64) as u64))?;
    progress.finish_and_clear();
    convergence.left_out.splice(0..0, programs.left_out.iter().cloned());
    external.iter().for_each(|external| external.add_to(&mut convergence));
    print_table(&convergence);
    save(arguments, workspace, &measured, &convergence)?;
    Ok(ExitCode::SUCCESS)
}

impl Arguments {
    fn options(&self, rubric: &Rubric) -> Options {
        Options {
            scenes: match self.scene.as_slice() {
                [] => DEFAULT_SCENES.map(str::to_owned).to_vec(),
                given => given.to_vec(),
            },
            techniques: match self.technique.as_slice() {
                [] => rubric.student_techniques(),
                given => given.to_vec(),
            },
            seconds: self.seconds,
            target: self.error,
            seed: self.seed,
            threads: usize::from(self.jobs),
            lengths: LENGTHS,
            bias: true,
        }
    }

    fn file(&self, extension: &str) -> PathBuf {
        self.out.join("convergence").with_extension(extension)
    }
}

/// Writes the measurements as JSON, CSV and SVG, and the page with crops.
fn save(
    arguments: &Arguments,
    workspace: &Workspace,
    programs: &[MeasuredProgram<'_>],
    convergence: &Convergence,
) -> Result<()> {
    save_json(convergence, &arguments.file("json"))?;
    save_csv(convergence, &arguments.file("csv"))?;
    if let Some(plot) = svg(convergence, Axis::Seconds) {
        output::write_bytes(&arguments.file("svg"), plot)?;
    }
    note("rendering crops at equal time …");
    let html = arguments.file("html");
    output::write_bytes(&html, page(convergence, &crops(workspace, programs, convergence)?))?;
    note(format_args!("page, plot and numbers: {}, .svg, .csv, .json", html.display()));
    Ok(())
}

/// Steps of the progress bar.
const STEPS: u64 = 1000;

/// A bar on a terminal, hidden elsewhere.
fn progress_bar() -> ProgressBar {
    let bar = ProgressBar::new(STEPS);
    ProgressStyle::with_template("{bar:30} {percent:>3} %  {elapsed_precise}  measuring")
        .map_or_else(|_| bar.clone(), |style| bar.clone().with_style(style))
}

fn above_zero(text: &str) -> std::result::Result<f64, String> {
    let number = text.parse().ok().filter(|number: &f64| number.is_finite() && *number > 0.0);
    number.ok_or_else(|| "expected a number above 0".to_owned())
}
