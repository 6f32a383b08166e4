//! The commands of the program.

mod assignment;
mod calibrate;
mod class;
mod completions;
mod converge;
mod doctor;
mod export;
mod figures;
mod full_report;
mod grade;
mod gradescope;
mod handout;
mod lateness;
mod least_sandbox;
mod mark;
mod mutants;
mod pack;
mod plan;
mod policy;
mod reference;
mod replay;
mod signatures;
mod stability;
mod trusted;
mod watch;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// Builds, runs and judges hand-ins of the path tracing exercise.
#[derive(Parser)]
#[command(name = "grader", version, propagate_version = true)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Grade one hand-in: build it, run its checks, print points, write report.json.
    Grade(grade::Arguments),
    /// Measure how often correct hand-ins fail, and how small an error is found (for staff).
    Calibrate(calibrate::Arguments),
    /// Tell what this machine gives for grading: compiler, linker, sandbox, and how to get a better one.
    Doctor(doctor::Arguments),
    /// Grade a class: a folder of hand-ins, with deadlines, a gradebook and the files of course systems (for staff).
    Class(class::Arguments),
    /// Pack your hand-in: checks that it compiles, packs it, prints its MD5 checksum.
    Pack(pack::Arguments),
    /// Measure the error of hand-ins against run time, beside the solution: CSV, JSON, SVG.
    Converge(converge::Arguments),
    /// Write a report in the format of another system: Markdown, JUnit, GitHub, Gradescope, Classroom 50, Autolab.
    Export(export::Arguments),
    /// Pack the grader for Gradescope: a zip with setup.sh and run_autograder (for staff).
    Gradescope(gradescope::Arguments),
    /// Print the completions of a shell: bash, elvish, fish, powershell or zsh.
    Completions(completions::Arguments),
    /// Make the folder that students get, without the solution (for staff).
    Handout(handout::Arguments),
    /// Render the figures of the sheet with the solution (for staff).
    Figures(figures::Arguments),
    /// Record the points that a person gives for a task.
    Mark(mark::Arguments),
    /// Grade wrong and right variants of the solution: what is caught, and what is not (for staff).
    Mutants(mutants::Arguments),
    /// Say which checks mean something in a scene, and why others are left out.
    Plan(plan::Arguments),
    /// Render the references of scenes with the solution (for staff).
    Reference(reference::Arguments),
    /// Follow one path again and show every call of the hand-in.
    Replay(replay::Arguments),
    /// Measure how known mistakes look to the checks, and how often they are named (for staff).
    Signatures(signatures::Arguments),
    /// Measure the limits of the framework in sweeps and extreme scenes (for staff).
    Stability(stability::Arguments),
}

/// Runs the command line. The exit status is 0 if the command did its work, whatever the points; 1 for fewer points
/// than `--fail-under`, or a variant that is not as expected; 2 if the command line or an input is wrong; 3 if the grader itself failed.
pub fn run() -> ExitCode {
    let outcome = match Arguments::parse().command {
        Command::Grade(arguments) => grade::run(&arguments),
        Command::Calibrate(arguments) => calibrate::run(&arguments),
        Command::Doctor(arguments) => doctor::run(&arguments),
        Command::Class(arguments) => class::run_class(&arguments),
        Command::Pack(arguments) => pack::run(&arguments),
        Command::Converge(arguments) => converge::run(&arguments),
        Command::Export(arguments) => export::run(&arguments),
        Command::Gradescope(arguments) => gradescope::run(&arguments),
        Command::Completions(arguments) => completions::run(&arguments),
        Command::Handout(arguments) => handout::run(&arguments),
        Command::Figures(arguments) => figures::run(&arguments),
        Command::Mark(arguments) => mark::run(&arguments),
        Command::Mutants(arguments) => mutants::run(&arguments),
        Command::Plan(arguments) => plan::run(&arguments),
        Command::Reference(arguments) => reference::run(&arguments),
        Command::Replay(arguments) => replay::run(&arguments),
        Command::Signatures(arguments) => signatures::run(&arguments),
        Command::Stability(arguments) => stability::run(&arguments),
    };
    outcome.unwrap_or_else(|error| {
        eprintln!("error: {error}");
        error.exit_code()
    })
}
