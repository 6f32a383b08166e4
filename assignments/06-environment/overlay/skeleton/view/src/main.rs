//! The renderer's window, with the student's algorithms: `cargo view SCENE.yml`.

#[path = "../../src/algorithms/mod.rs"]
pub mod algorithms;

use std::process::ExitCode;

use algorithms::{environment::PathTracer, render_debug::DebugTracer};
use arty::cli::Algorithm;
use arty_view::{Program, run};

fn main() -> ExitCode {
    run(&Program {
        make: |algorithm, scene| match algorithm {
            Algorithm::Debug(view) => Box::new(DebugTracer::new(view)),
            Algorithm::PathTracer(settings) => Box::new(PathTracer::new(settings, scene)),
        },
        source: concat!(env!("CARGO_MANIFEST_DIR"), "/../src/algorithms/environment.rs"),
        workspace: concat!(env!("CARGO_MANIFEST_DIR"), "/../.."),
        build: &["--bin=arty-view", "--features=arty-view/window"],
    })
}
