//! The renderer program with the solution of exercise 6.

#[path = "../../assignments/06-environment/solution.rs"]
pub mod environment;
#[path = "../../skeleton/src/algorithms/render_debug.rs"]
pub mod render_debug;

use std::process::ExitCode;

use arty::cli::{self, Algorithm};
use environment::PathTracer;
use render_debug::DebugTracer;

fn main() -> ExitCode {
    cli::run(|algorithm, scene| match algorithm {
        Algorithm::Debug(view) => Box::new(DebugTracer::new(view)),
        Algorithm::PathTracer(settings) => Box::new(PathTracer::new(settings, scene)),
    })
}
