//! The program: from a command line to a picture.
//!
//! | module | what it is about |
//! |---|---|
//! | `args`, `original_options` | the command line |
//! | `plan` | what to render, once the scene is known |
//! | `session`, `passes` | rendering in passes, until the limits are reached or someone interrupts |
//! | `progress`, `live`, `messages`, `numbers`, `notes` | what is said and shown meanwhile |
//! | `output` | picture files |
//! | `errors` | the error against a reference |
//! | `exit` | what a run ends with |

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
mod progress;
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
use self::progress::Progress;

/// What the program is asked to show. `main` knows how to make the integrator for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Algorithm {
    /// A property of the surfaces that the camera sees.
    Debug(DebugView),
    /// The light of the scene, by path tracing.
    PathTracer(Settings),
}

/// What the debug algorithm shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum DebugView {
    /// Shading normals: x, y and z in [-1, 1] as red, green and blue in [0, 1].
    Normals,
    /// The share of light that surfaces scatter.
    Albedo,
}

impl DebugView {
    /// Its name on command lines and in pictures.
    fn name(self) -> &'static str {
        match self {
            Self::Normals => "normals",
            Self::Albedo => "albedo",
        }
    }
}

/// Runs the program with the arguments of this process; `make` makes the integrator for an algorithm.
///
/// The exit status is 0 if the picture is there as it was asked for; 2 if the command line, the scene or a place
/// for the picture is wrong, which is found out before anything is rendered; 3 if the program itself failed; 130
/// if it was interrupted (the picture is saved with the samples it has by then).
pub fn run(make: impl FnOnce(Algorithm) -> Box<dyn Integrator>) -> ExitCode {
    let args = match Args::read(std::env::args_os()) {
        Ok(args) => args,
        Err(answer) => return exit::answer(&answer),
    };
    match execute(&args, make) {
        Ok(exit) => exit.into(),
        Err(failure) => {
            messages::error(&failure);
            failure.exit().into()
        }
    }
}

fn execute(args: &Args, make: impl FnOnce(Algorithm) -> Box<dyn Integrator>) -> Result<Exit, Failure> {
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
    // The scene has its own copy of what it needs.
    drop(loaded);

    // Until here, Ctrl-C simply ends the program: there is nothing to save.
    let stop = interrupt::stop_flag()?;
    if !args.quiet {
        notes::before(&plan.algorithm, scene.features()).iter().for_each(messages::note);
        messages::plain(format_args!("rendering {}: {plan}", args.scene.display()));
    }
    let integrator = make(plan.algorithm);
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

    notes::anomalies(rendering.film.anomalies()).iter().for_each(messages::warning);
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
