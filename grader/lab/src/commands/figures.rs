//! `cargo lab figures`.

use std::process::ExitCode;

use arty::image::write_png;

use crate::figures::{figures, render};
use crate::output::create_folder;
use harness::assignment::AssignmentOption;
use harness::workspace::Workspace;
use judge::reference::Oracle;
use verdict::error::{Error, Result};

/// Render the figures of the exercise sheet with the solution
#[derive(clap::Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    assignment: AssignmentOption,
    /// Seed of all random numbers
    #[arg(long, default_value_t = 5)]
    seed: u64,
}

pub(super) fn run(arguments: &Arguments) -> Result<ExitCode> {
    let workspace = Workspace::find()?;
    let assignment = arguments.assignment.open(&workspace)?;
    let folder = assignment.folder.figures();
    create_folder(&folder)?;
    let program = Oracle::required(&workspace, &assignment)?;
    for figure in figures(&assignment.folder)? {
        eprintln!("{} …", figure.file);
        let image = render(&workspace, &program, &figure.panels, arguments.seed)?;
        write_png(&folder.join(&figure.file), &image, 0.0)
            .map_err(|error| Error::Output(error.to_string()))?;
    }
    Ok(ExitCode::SUCCESS)
}
