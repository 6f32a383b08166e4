//! The commands of the program.

mod calibrate;
mod figures;
mod gradescope;
mod handout;
mod limits;
mod mutants;
mod reference;
mod signatures;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// Measures the grader itself, and makes what it rests on: references, figures, handouts (for staff).
#[derive(Parser)]
#[command(name = "lab", version, propagate_version = true)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Calibrate(calibrate::Arguments),
    Figures(figures::Arguments),
    Gradescope(gradescope::Arguments),
    Handout(handout::Arguments),
    Limits(limits::Arguments),
    Mutants(mutants::Arguments),
    Reference(reference::Arguments),
    Signatures(signatures::Arguments),
}

/// Runs the command line. The exit status is 0 if the command did its work; 1 if a variant is not as expected; 2 if the
/// command line or an input is wrong; 3 if the laboratory itself failed.
pub fn run() -> ExitCode {
    let outcome = match Arguments::parse().command {
        Command::Calibrate(arguments) => calibrate::run(&arguments),
        Command::Figures(arguments) => figures::run(&arguments),
        Command::Gradescope(arguments) => gradescope::run(&arguments),
        Command::Handout(arguments) => handout::run(&arguments),
        Command::Limits(arguments) => limits::run(&arguments),
        Command::Mutants(arguments) => mutants::run(&arguments),
        Command::Reference(arguments) => reference::run(&arguments),
        Command::Signatures(arguments) => signatures::run(&arguments),
    };
    outcome.unwrap_or_else(|error| {
        eprintln!("error: {error}");
        error.exit_code()
    })
}
