//! The renderer's window, with the solution.

pub mod algorithms;

use std::process::ExitCode;

use algorithms::{render_debug::DebugTracer, render_pt::PathTracer};
use arty::cli::Algorithm;
use arty_view::{Program, run};

fn main() -> ExitCode {
    run(&Program {
        make: |algorithm, _| match algorithm {
            Algorithm::Debug(view) => Box::new(DebugTracer::new(view)),
            Algorithm::PathTracer(settings) => Box::new(PathTracer::new(settings)),
        },
        source: concat!(env!("CARGO_MANIFEST_DIR"), "/src/algorithms/render_pt.rs"),
        workspace: concat!(env!("CARGO_MANIFEST_DIR"), "/.."),
        build: &["--bin=solution-view", "--features=solution/view"],
    })
}
