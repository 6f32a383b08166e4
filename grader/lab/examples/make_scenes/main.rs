//! Writes the public scenes of the exercise into `scenes/`, or checks that they are as this program would
//! write them.
//!
//! The files in `scenes/` beside this one hold every number of every scene, with reasons. To add a scene, copy one of
//! them.
//!
//! ```text
//! cargo run --release -p lab --example make_scenes              # writes
//! cargo run --release -p lab --example make_scenes -- --check   # compares, status 1 on a difference
//! ```

mod collection;
mod extreme;
mod model;
mod number;
mod output;
mod picture;
#[cfg(test)]
mod raycast;
mod scene_file;
mod scenes;
mod shapes;
mod solids;
mod soundness;
mod surface;
#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// The folder that is written: `scenes/` at the top of the repository.
fn scenes_folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes")
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let check_only = match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [] => false,
        ["--check"] => true,
        _ => {
            eprintln!("usage: make_scenes [--check]");
            return ExitCode::from(2);
        }
    };

    let collection = scenes::all();
    let extremes = extreme::all();
    let mut faults = soundness::faults(&collection);
    faults.extend(soundness::faults_of_names(&extremes.collection));
    if !faults.is_empty() {
        eprintln!("nothing written, because the scenes are not sound:\n{}", faults.join("\n"));
        return ExitCode::from(3);
    }

    let mut files = collection.files("scene.schema.json");
    files.extend(extremes.files());
    if check_only {
        let differences = output::differences(&scenes_folder(), &files);
        for difference in &differences {
            eprintln!("{difference}");
        }
        if !differences.is_empty() {
            eprintln!("run `cargo run --release -p lab --example make_scenes` to write them anew");
            return ExitCode::FAILURE;
        }
        println!("{} files are as they should be", files.len());
        return ExitCode::SUCCESS;
    }
    match output::write(&scenes_folder(), &files) {
        Ok(()) => {
            println!("{} files written", files.len());
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("cannot write the scenes: {error}");
            ExitCode::from(3)
        }
    }
}
