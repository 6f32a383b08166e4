//! `grader converge`.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;

use super::intake::reader;
use arty::integrator::Technique;
use indicatif::{ProgressBar, ProgressStyle};

use harness::build::{Framework, SubmissionProgram, compile};
use harness::sandbox::Limits;
use harness::workspace::Workspace;
use judge::convergence::{MeasuredProgram, Options, crops, measure};
use judge::reference::Oracle;
use present::convergence::{page, print_table, save_csv, save_json, svg};
use present::streams::note;
use verdict::convergence::{Convergence, DEFAULT_SCENES, NotMeasured, Role};
use verdict::error::Result;
use verdict::output;

/// Measure the error of submissions against run time, in comparison with the solution and plain BSDF sampling
///
/// Each point on a curve comes from many independent renderings of the same length, measured in processor time;
/// programs take turns. Errors are relative MSEs against the stored references, whose own noise is subtracted. The
/// curve of an unbiased program falls with slope −1; a curve that flattens indicates a bias. Writes convergence.svg,
/// .csv and .json, and convergence.html with the plot and crops at equal time.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Submissions, each a render_pt.rs or a folder with one in it [default: the student file in the skeleton]
    submissions: Vec<PathBuf>,
    /// Scene by name; repeatable [default: cornell_box, cornell_box_glossy, veach_mis, many_lights]
    #[arg(long, value_name = "SCENE")]
    scene: Vec<String>,
    /// Technique; repeatable [default: nee and mis]
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
const LENGTHS: u32 = 7;

pub(super) fn run(arguments: &Arguments, workspace: &Workspace) -> Result<ExitCode> {
    output::create_folder(&arguments.out)?;
    for extension in ["svg", "csv", "json", "html"] {
        output::check_writable(&arguments.file(extension))?;
    }
    let programs = Programs::build(&arguments.submissions, workspace)?;
    let measured = programs.measured();
    let progress = progress_bar();
    let mut convergence = measure(workspace, &measured, &arguments.options(), |done| {
        progress.set_position((done * STEPS as f64) as u64)
    })?;
    progress.finish_and_clear();
    convergence.left_out.splice(0..0, programs.left_out.iter().cloned());
    print_table(&convergence);
    save(arguments, workspace, &measured, &convergence)?;
    Ok(ExitCode::SUCCESS)
}

impl Arguments {
    fn options(&self) -> Options {
        Options {
            scenes: match self.scene.as_slice() {
                [] => DEFAULT_SCENES.map(str::to_owned).to_vec(),
                given => given.to_vec(),
            },
            techniques: match self.technique.as_slice() {
                [] => vec![Technique::Nee, Technique::Mis],
                given => given.to_vec(),
            },
            seconds: self.seconds,
            target: self.error,
            seed: self.seed,
            threads: usize::from(self.jobs),
            lengths: LENGTHS,
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
    if let Some(plot) = svg(convergence) {
        output::write_bytes(&arguments.file("svg"), plot)?;
    }
    note("rendering crops at equal time …");
    let html = arguments.file("html");
    output::write_bytes(&html, page(convergence, &crops(workspace, programs, convergence)?))?;
    note(format_args!("page, plot and numbers: {}, .svg, .csv, .json", html.display()));
    Ok(())
}

/// The programs that are measured.
struct Programs {
    /// Submissions that compile, with their names.
    submissions: Vec<(String, SubmissionProgram)>,
    /// `None` if the checkout does not have it.
    solution: Option<Arc<SubmissionProgram>>,
    /// Programs that cannot be measured.
    left_out: Vec<NotMeasured>,
}

impl Programs {
    /// Compiles submissions, without any the student file, and the solution.
    fn build(paths: &[PathBuf], workspace: &Workspace) -> Result<Self> {
        let paths = if paths.is_empty() { vec![workspace.student_file()] } else { paths.to_vec() };
        let sources = paths.iter().map(|path| reader().read(path)).collect::<Result<Vec<_>>>()?;
        let framework = Framework::build(workspace)?;
        let mut left_out = Vec::new();
        let mut submissions = Vec::new();
        for (submission, name) in sources.iter().zip(names(&paths)) {
            match compile(&framework, &submission.source, &Limits::default())? {
                Ok(program) => submissions.push((name, program)),
                Err(_) => left_out.push(everywhere(name, "it does not compile")),
            }
        }
        let solution = Oracle::of(workspace, &framework)?.map(|oracle| oracle.program()).transpose()?;
        if solution.is_none() {
            left_out.push(everywhere("the solution".to_owned(), "this checkout does not have it"));
        }
        Ok(Self { submissions, solution, left_out })
    }

    /// All programs in the order of the curves. BSDF sampling is that of the solution, or else of the first submission.
    fn measured(&self) -> Vec<MeasuredProgram<'_>> {
        let named = |name: &str, role, program| MeasuredProgram { name: name.to_owned(), role, program };
        let submissions = self.submissions.iter();
        let mut all: Vec<MeasuredProgram<'_>> =
            submissions.map(|(name, program)| named(name, Role::Submission, program)).collect();
        let solution = self.solution.as_deref();
        all.extend(solution.map(|program| named("solution", Role::Solution, program)));
        let baseline = solution.or(self.submissions.first().map(|(_, program)| program));
        all.extend(baseline.map(|program| named("BSDF sampling", Role::Baseline, program)));
        all
    }
}

fn everywhere(program: String, why: &str) -> NotMeasured {
    NotMeasured { program, scene: String::new(), why: why.to_owned() }
}

/// Names of submissions: file or folder, or the whole path where several would have the same name.
fn names(paths: &[PathBuf]) -> Vec<String> {
    let short = |path: &Path| {
        let name = if path.file_name().is_some_and(|name| name == verdict::submission::FILE_NAME) {
            path.parent().and_then(Path::file_name)
        } else {
            path.file_stem()
        };
        name.map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned())
    };
    let all: Vec<String> = paths.iter().map(|path| short(path)).collect();
    let is_unique = |name: &String| all.iter().filter(|other| *other == name).count() == 1;
    let name = |(path, name): (&PathBuf, &String)| {
        if is_unique(name) { name.clone() } else { path.display().to_string() }
    };
    paths.iter().zip(&all).map(name).collect()
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn submissions_of_the_same_name_are_told_apart_by_their_paths() {
        let paths = ["a/render_pt.rs", "b.rs", "x/c.rs", "y/c.rs"].map(PathBuf::from);
        assert_eq!(names(&paths), ["a", "b", "x/c.rs", "y/c.rs"]);
    }
}
