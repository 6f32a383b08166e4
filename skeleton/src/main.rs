//! The renderer program.

pub mod algorithms;

use std::process::ExitCode;

use algorithms::{render_debug::DebugTracer, render_pt::PathTracer};
use arty::cli::{self, Algorithm};

fn main() -> ExitCode {
    cli::run(|algorithm, _| match algorithm {
        Algorithm::Debug(view) => Box::new(DebugTracer::new(view)),
        Algorithm::PathTracer(settings) => Box::new(PathTracer::new(settings)),
    })
}
