//! `grader converge`.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use arty::image::check_writable;
use arty::integrator::Technique;
use indicatif::{ProgressBar, ProgressStyle};

use harness::build::{Framework, compile};
use harness::sandbox::Limits;
use harness::workspace::Workspace;
use judge::convergence::{Contestant, Options, crops, measure};
use judge::reference::Oracle;
use present::convergence::{page, print_table, save_csv, save_json, svg};
use verdict::convergence::{Role, TELLING_SCENES};
use verdict::error::{Error, Result};
use verdict::report::LeftOut;

/// Measure the error of submissions against run time, beside the solution and plain BSDF sampling.
///
/// Separate renderings of several lengths, in turns with the other programs, on the processor time that each took.
/// Errors are relative MSEs against the stored references, whose own noise is subtracted. The line of an unbiased
/// program falls with slope −1; one that flattens has a bias. Writes convergence.svg, .csv and .json, and
/// convergence.html with the plot and crops after equal time.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Each a render_pt.rs, or a folder with one in it [default: the student file in the skeleton]
    submissions: Vec<PathBuf>,
    /// Scenes by name; may be given several times [default: four that tell much]
    #[arg(long, value_name = "SCENE")]
    scene: Vec<String>,
    /// Techniques; may be given several times [default: nee and mis]
    #[arg(long, value_name = "TECHNIQUE")]
    technique: Vec<Technique>,
    /// Processor time for all of it, in seconds
    #[arg(long, default_value_t = 60.0, value_parser = above_zero)]
    seconds: f64,
    /// Give the time to this relative MSE [default: what the solution has halfway]
    #[arg(long, value_name = "ERROR", value_parser = above_zero)]
    error: Option<f64>,
    /// Seed of all random numbers
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Threads of each program; more than one makes its processor time less certain
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=256))]
    jobs: u16,
    /// Folder for the results; it is made if it is not there
    #[arg(long, value_name = "DIR", default_value = "convergence")]
    out: PathBuf,
}

/// Lengths of renderings, from the shortest to the longest.
const LENGTHS: u32 = 7;

pub(super) fn run(arguments: &Arguments) -> Result<ExitCode> {
    let workspace = Workspace::find()?;
    let paths = if arguments.submissions.is_empty() {
        vec![workspace.student_file()]
    } else {
        arguments.submissions.clone()
    };
    let submissions = paths.iter().map(|path| intake::read(path)).collect::<Result<Vec<_>>>()?;
    let or_default = |given: &[String]| match given.is_empty() {
        true => TELLING_SCENES.map(str::to_owned).to_vec(),
        false => given.to_vec(),
    };
    let options = Options {
        scenes: or_default(&arguments.scene),
        techniques: match arguments.technique.is_empty() {
            true => vec![Technique::Nee, Technique::Mis],
            false => arguments.technique.clone(),
        },
        seconds: arguments.seconds,
        target: arguments.error,
        seed: arguments.seed,
        threads: usize::from(arguments.jobs),
        lengths: LENGTHS,
    };
    std::fs::create_dir_all(&arguments.out).map_err(|error| Error::file(&arguments.out, error))?;
    let file = |extension: &str| arguments.out.join("convergence").with_extension(extension);
    ["svg", "csv", "json", "html"].into_iter().try_for_each(|extension| check_writable(&file(extension)))?;

    let framework = Framework::build(&workspace)?;
    let mut left_out = Vec::new();
    let mut programs = Vec::new();
    for (submission, name) in submissions.iter().zip(names(&paths)) {
        match compile(&framework, &submission.source, &Limits::default())? {
            Ok(program) => programs.push((name, program)),
            Err(_) => left_out.push(left_out_everywhere(&name, "it does not compile")),
        }
    }
    let solution = Oracle::of(&workspace, &framework)?.map(|oracle| oracle.program()).transpose()?;
    if solution.is_none() {
        left_out.push(left_out_everywhere("the solution", "it is not in this checkout"));
    }
    let mut contestants: Vec<Contestant<'_>> = programs
        .iter()
        .map(|(name, program)| Contestant { name: name.clone(), role: Role::Submission, program })
        .collect();
    let named = |name: &str, role, program| Contestant { name: name.to_owned(), role, program };
    contestants.extend(solution.as_deref().map(|program| named("solution", Role::Solution, program)));
    if let Some(program) = solution.as_deref().or(programs.first().map(|(_, program)| program)) {
        contestants.push(named("BSDF sampling", Role::Baseline, program));
    }

    let progress = progress_bar();
    let mut convergence = measure(&workspace, &contestants, &options, |done| {
        progress.set_position((done * STEPS as f64) as u64)
    })?;
    progress.finish_and_clear();
    convergence.left_out.splice(0..0, left_out);
    save_json(&convergence, &file("json"))?;
    save_csv(&convergence, &file("csv"))?;
    if let Some(picture) = svg(&convergence) {
        arty::image::write_aside(&file("svg"), |writer| {
            std::io::Write::write_all(writer, picture.as_bytes())
        })?;
    }
    eprintln!("rendering crops after equal time …");
    let text = page(&convergence, &crops(&workspace, &contestants, &convergence)?);
    arty::image::write_aside(&file("html"), |writer| std::io::Write::write_all(writer, text.as_bytes()))?;
    print_table(&convergence);
    eprintln!("page, plot and numbers: {}, .svg, .csv, .json", file("html").display());
    Ok(ExitCode::SUCCESS)
}

/// What each submission is called: by its file or folder, or by all of its path where that is the name of several.
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

fn left_out_everywhere(name: &str, why: &str) -> LeftOut {
    LeftOut { check: format!("convergence of {name}"), scene: String::new(), why: why.to_owned() }
}

/// Steps of the bar.
const STEPS: u64 = 1000;

/// A bar on a terminal, nothing elsewhere.
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
    fn submissions_are_called_by_what_tells_them_apart() {
        let paths = ["a/render_pt.rs", "b.rs", "x/c.rs", "y/c.rs"].map(PathBuf::from);
        assert_eq!(names(&paths), ["a", "b", "x/c.rs", "y/c.rs"]);
    }
}
