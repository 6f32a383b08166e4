//! The renderer program.

pub mod algorithms;

use std::process::ExitCode;

use algorithms::{environment::PathTracer, render_debug::DebugTracer};
use arty::cli::{self, Algorithm};

fn main() -> ExitCode {
    cli::run(|algorithm, scene| match algorithm {
        Algorithm::Debug(view) => Box::new(DebugTracer::new(view)),
        Algorithm::PathTracer(settings) => Box::new(PathTracer::new(settings, scene)),
    })
}
