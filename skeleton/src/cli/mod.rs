//! The command line: from arguments to an image file.
//!
//! | module | contents |
//! |---|---|
//! | `args`, `original_options`, `scene_name` | command-line arguments |
//! | `plan` | render settings, from the arguments and the scene's defaults |
//! | `session`, `passes` | rendering in passes, until a limit is reached or an interruption |
//! | `progress`, `live`, `messages`, `numbers`, `notes` | progress display and messages |
//! | `output` | image files |
//! | `errors` | the error against a reference |
//! | `inspect` | statistics of a scene |
//! | `programs` | starting the programs of the window and of the conversion of glTF files |
//! | `exit` | exit status and failures |

mod args;
mod errors;
mod exit;
mod inspect;
mod interrupt;
mod live;
mod messages;
mod notes;
mod numbers;
mod original_options;
mod output;
mod passes;
mod plan;
mod programs;
mod progress;
mod scene_name;
mod session;

use std::process::ExitCode;

use crate::integrator::{Integrator, Settings};
use crate::scene::{Scene, file};

use self::args::Args;
use self::errors::{ErrorLog, Reference};
use self::exit::{Exit, Failure};
use self::live::Live;
use self::output::Provenance;
use self::plan::Plan;
pub use self::plan::{DEFAULT_MAX_BOUNCES, image_size};
use self::progress::Progress;
pub use self::scene_name::resolve as scene_file;

/// The algorithm to render with. `main` makes the integrator for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Algorithm {
    /// A property of the visible surfaces.
    Debug(DebugView),
    /// Light transport by path tracing.
    PathTracer(Settings),
}

/// The property that the debug algorithm shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum DebugView {
    /// Shading normals: x, y, z in [-1, 1] as red, green, blue in [0, 1].
    Normals,
    /// The fraction of light that surfaces scatter.
    Albedo,
}

impl DebugView {
    /// The name on command lines and in image metadata.
    fn name(self) -> &'static str {
        match self {
            Self::Normals => "normals",
            Self::Albedo => "albedo",
        }
    }
}

/// The options of the program, for completions.
pub fn command_line() -> clap::Command {
    <Args as clap::CommandFactory>::command()
}

/// Runs the program with the arguments of this process; `make` makes the integrator for an algorithm and
/// the scene that it will render.
///
/// The exit status is 0 on success; 2 for an invalid command line, scene or output file, which is detected before
/// anything is rendered; 3 for an internal error or a panic of the algorithm; 130 after an interruption (the image is
/// saved with the samples rendered so far).
pub fn run(make: impl FnOnce(Algorithm, &Scene) -> Box<dyn Integrator>) -> ExitCode {
    if let Some(arguments) = programs::import_requested(std::env::args_os()) {
        return programs::import(arguments);
    }
    let executable = std::env::current_exe().unwrap_or_default();
    if let Some(arguments) = programs::window_requested(&executable, std::env::args_os()) {
        return programs::window(arguments);
    }
    let args = match Args::read(std::env::args_os()) {
        Ok(args) => args,
        Err(answer) => return exit::answer(&answer),
    };
    match execute(args, make) {
        Ok(exit) => exit.into(),
        Err(failure) => {
            messages::error(&failure);
            failure.exit().into()
        }
    }
}

fn execute(
    mut args: Args,
    make: impl FnOnce(Algorithm, &Scene) -> Box<dyn Integrator>,
) -> Result<Exit, Failure> {
    args.scene = scene_name::resolve(&args.scene)?;
    let args = &args;
    if args.view {
        return Err(Failure::Window);
    }
    let loaded = file::load(&args.scene)?;
    let scene = Scene::new(&loaded.description);
    if args.features {
        inspect::print(args, &loaded, &scene);
        return Ok(Exit::Done);
    }
    loaded.warnings.iter().for_each(messages::warning);
    scene.warnings().iter().for_each(messages::warning);

    let reference = Reference::open(args, &loaded.description)?;
    let defaults =
        reference.as_ref().map_or(scene.defaults(), |reference| reference.defaults(scene.defaults()));
    let plan = Plan::new(args, defaults)?;
    let mut errors = reference.map(|reference| ErrorLog::new(reference, args, &plan)).transpose()?;
    plan.outputs.iter().try_for_each(|output| output.check())?;
    let provenance = Provenance::new(&args.scene, &loaded.description, &plan);
    // The scene has its own copy of the data.
    drop(loaded);

    // Up to here Ctrl-C just ends the program: there is nothing to save.
    let stop = interrupt::stop_flag()?;
    if !args.quiet {
        notes::before(&plan.algorithm, scene.features()).iter().for_each(messages::note);
        messages::plain(format_args!("rendering {}: {plan}", args.scene.display()));
    }
    session::print_first_panic_only();
    let integrator = make(plan.algorithm, &scene);
    let mut progress = Progress::new(args.quiet);
    let mut live = Live::open(args.tev.as_deref(), provenance.title(), &plan);
    let rendering = session::render_scene(&*integrator, &scene, &plan, &stop, |film, state| {
        progress.update(state);
        live.update(film, &progress);
        if let Some(errors) = &mut errors {
            errors.update(film, state.elapsed.as_secs_f64(), &progress);
        }
    });
    progress.finish();
    let rendering = rendering?;
    live.finish(&rendering.film);

    let anomalies = rendering.film.anomalies();
    notes::anomalies(anomalies).iter().for_each(messages::warning);
    notes::replay(anomalies, &args.scene, &plan).iter().for_each(messages::plain);
    if !args.quiet {
        notes::after(&plan.algorithm, scene.features(), &rendering).iter().for_each(messages::note);
        messages::plain(&rendering);
    }
    if let Some(errors) = errors {
        errors.finish(&rendering.film, rendering.elapsed.as_secs_f64())?;
    }
    output::save_all(&plan, &provenance, &rendering, args.quiet)?;
    Ok(if rendering.interrupted { Exit::Interrupted } else { Exit::Done })
}
