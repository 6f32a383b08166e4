//! `cargo lab figures`.

use std::process::ExitCode;

use arty::image::write_png;

use crate::figures::{FIGURES, render};
use crate::output::create_folder;
use harness::assignment::Assignment;
use harness::workspace::Workspace;
use judge::reference::Oracle;
use verdict::error::{Error, Result};

/// Render the figures of the exercise sheet with the solution
#[derive(clap::Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    assignment: Assignment,
    /// Seed of all random numbers
    #[arg(long, default_value_t = 5)]
    seed: u64,
}

pub(super) fn run(arguments: &Arguments) -> Result<ExitCode> {
    let workspace = Workspace::find()?;
    let folder = workspace.assignment(&arguments.assignment.name).figures();
    create_folder(&folder)?;
    let program = Oracle::required(&workspace)?;
    for (name, panels) in FIGURES {
        eprintln!("{name} …");
        let figure = render(&workspace, &program, panels, arguments.seed)?;
        write_png(&folder.join(name), &figure, 0.0).map_err(|error| Error::Output(error.to_string()))?;
    }
    Ok(ExitCode::SUCCESS)
}
