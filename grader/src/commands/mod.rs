//! The commands of the program.

mod class;
mod completions;
mod converge;
mod doctor;
mod export;
mod full_report;
mod grade;
mod lateness;
mod mark;
mod min_sandbox;
mod pack;
mod plan;
mod policy;
mod replay;
mod watch;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// Builds, runs and judges submissions of the path tracing exercise.
#[derive(Parser)]
#[command(name = "grader", version, propagate_version = true)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Grade one submission: build it, run its checks, print points, write report.json.
    Grade(grade::Arguments),
    /// Tell what this machine gives for grading: compiler, linker, sandbox, and how to get a better one.
    Doctor(doctor::Arguments),
    /// Grade a class: a folder of submissions, with deadlines, a gradebook and the files of course systems (for staff).
    Class(class::Arguments),
    /// Pack your submission: checks that it compiles, packs it, prints its MD5 checksum.
    Pack(pack::Arguments),
    /// Measure the error of submissions against run time, beside the solution: CSV, JSON, SVG.
    Converge(converge::Arguments),
    /// Write a report in the format of another system: Markdown, JUnit, GitHub, Gradescope, Classroom 50, Autolab.
    Export(export::Arguments),
    /// Print the completions of a shell: bash, elvish, fish, powershell or zsh.
    Completions(completions::Arguments),
    /// Record the points that a person gives for a task.
    Mark(mark::Arguments),
    /// Say which checks mean something in a scene, and why others are left out.
    Plan(plan::Arguments),
    /// Follow one path again and show every call of the submission.
    Replay(replay::Arguments),
}

/// Runs the command line. The exit status is 0 if the command did its work, whatever the points; 1 for fewer points
/// than `--fail-under`, or a variant that is not as expected; 2 if the command line or an input is wrong; 3 if the grader itself failed.
pub(crate) fn run() -> ExitCode {
    let outcome = match Arguments::parse().command {
        Command::Grade(arguments) => grade::run(&arguments),
        Command::Doctor(arguments) => doctor::run(&arguments),
        Command::Class(arguments) => class::run_class(&arguments),
        Command::Pack(arguments) => pack::run(&arguments),
        Command::Converge(arguments) => converge::run(&arguments),
        Command::Export(arguments) => export::run(&arguments),
        Command::Completions(arguments) => completions::run(&arguments),
        Command::Mark(arguments) => mark::run(&arguments),
        Command::Plan(arguments) => plan::run(&arguments),
        Command::Replay(arguments) => replay::run(&arguments),
    };
    outcome.unwrap_or_else(|error| {
        eprintln!("error: {error}");
        error.exit_code()
    })
}
