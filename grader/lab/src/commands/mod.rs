//! The commands: each reads its options, calls the rooms of the laboratory and reports.

mod calibrate;
mod compare;
mod coverage;
mod facts;
mod figures;
mod gradescope;
mod handout;
mod limits;
mod mutants;
mod new_assignment;
mod reference;
mod signatures;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// Measure the grader, and create references, figures, signatures and handouts (staff only)
///
/// Exit status: 0 = success, 1 = unexpected results, 2 = invalid command line or input, 3 = internal error, or output that
/// cannot be written.
#[derive(Parser)]
#[command(name = "lab", version, propagate_version = true)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Calibrate(calibrate::Arguments),
    Compare(compare::Arguments),
    Facts(facts::Arguments),
    Coverage(coverage::Arguments),
    Figures(figures::Arguments),
    Gradescope(gradescope::Arguments),
    Handout(handout::Arguments),
    LeaveOneOut(facts::LeaveOneOut),
    Limits(limits::Arguments),
    Mutants(mutants::Arguments),
    NewAssignment(new_assignment::Arguments),
    Reference(reference::Arguments),
    Signatures(signatures::Arguments),
}

/// Runs the command line.
pub fn run() -> ExitCode {
    let outcome = match Arguments::parse().command {
        Command::Calibrate(arguments) => calibrate::run(&arguments),
        Command::Compare(arguments) => compare::run(&arguments),
        Command::Facts(arguments) => facts::run(&arguments),
        Command::Coverage(arguments) => coverage::run(&arguments),
        Command::Figures(arguments) => figures::run(&arguments),
        Command::Gradescope(arguments) => gradescope::run(&arguments),
        Command::Handout(arguments) => handout::run(&arguments),
        Command::LeaveOneOut(arguments) => facts::run_leave_one_out(&arguments),
        Command::Limits(arguments) => limits::run(&arguments),
        Command::Mutants(arguments) => mutants::run(&arguments),
        Command::NewAssignment(arguments) => new_assignment::run(&arguments),
        Command::Reference(arguments) => reference::run(&arguments),
        Command::Signatures(arguments) => signatures::run(&arguments),
    };
    outcome.unwrap_or_else(|error| {
        eprintln!("error: {error}");
        error.exit_code()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn no_command_has_two_options_of_one_name() {
        Arguments::command().debug_assert();
    }
}
