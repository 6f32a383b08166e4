//! The commands of the program: one file a command. This file parses the command line and hands each command what it
//! needs.

mod audit;
mod class;
mod class_tables;
mod completions;
mod converge;
mod doctor;
mod export;
mod full_report;
mod grade;
mod hint;
mod intake;
mod lateness;
mod mark;
mod marks_table;
mod merge;
mod min_sandbox;
mod pack;
mod plan;
mod policy;
mod replay;
mod seed;
mod similar;
mod watch;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};

use harness::workspace::Workspace;
use present::streams::note;
use verdict::error::Result;
use verdict::text::message;

/// Build, run and grade submissions of the path tracing exercise.
#[derive(Parser)]
#[command(name = "grader", version, propagate_version = true)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
    /// Checkout to work in [default: the one that contains the current folder, else the one the grader was built from; if
    /// they differ, name one]
    #[arg(long, global = true, value_name = "DIR")]
    workspace: Option<PathBuf>,
}

// The help of each command is the doc comment of its arguments.
#[derive(Subcommand)]
enum Command {
    Grade(grade::Arguments),
    Hint(hint::Arguments),
    Audit(audit::Arguments),
    Doctor(doctor::Arguments),
    Class(class::Arguments),
    Pack(pack::Arguments),
    Converge(converge::Arguments),
    Export(export::Arguments),
    Completions(completions::Arguments),
    Mark(mark::Arguments),
    Merge(merge::Arguments),
    Plan(plan::Arguments),
    Replay(replay::Arguments),
    Similar(similar::Arguments),
    #[command(name = ::intake::COMMAND, hide = true)]
    Intake(intake::Arguments),
}

/// Runs the command line. The exit status is 0 if the command did its work, whatever the points; 1 for fewer points
/// than `--fail-under`; 2 if the command line or an input is wrong; 3 if the grader failed, or could not write a result.
pub(crate) fn run() -> ExitCode {
    let matches = command_line().get_matches();
    // What clap has parsed is what the same structure is read from.
    let arguments = Arguments::from_arg_matches(&matches).unwrap_or_else(|error| error.exit());
    arguments.run().unwrap_or_else(|error| {
        note(format_args!("error: {}", message(&error.to_string())));
        error.exit_code()
    })
}

impl Arguments {
    fn run(&self) -> Result<ExitCode> {
        let workspace = || self.workspace.as_deref().map_or_else(Workspace::find, Workspace::open);
        match &self.command {
            Command::Grade(arguments) => grade::run(arguments, &workspace()?),
            Command::Hint(arguments) => hint::run(arguments, &workspace()?),
            Command::Audit(arguments) => audit::run(arguments, &workspace()?),
            Command::Doctor(arguments) => doctor::run(arguments, &workspace()?),
            Command::Class(arguments) => class::run(arguments, &workspace()?),
            Command::Pack(arguments) => pack::run(arguments, &workspace()?),
            Command::Converge(arguments) => converge::run(arguments, &workspace()?),
            Command::Export(arguments) => export::run(arguments),
            Command::Completions(arguments) => completions::run(arguments, command_line()),
            Command::Mark(arguments) => mark::run(arguments, &workspace()?),
            Command::Merge(arguments) => merge::run(arguments, &workspace()?),
            Command::Plan(arguments) => plan::run(arguments, &workspace()?),
            Command::Replay(arguments) => replay::run(arguments, &workspace()?),
            Command::Similar(arguments) => similar::run(arguments, &workspace()?),
            Command::Intake(arguments) => intake::run(arguments),
        }
    }
}

/// Commands that `--help` shows only in a checkout with the solution.
const STAFF_COMMANDS: [&str; 7] = ["class", "mark", "merge", "plan", "export", "converge", "similar"];

/// Options of `grade` that `--help` shows only there.
const STAFF_OPTIONS: [&str; 5] = ["missing_is_zero", "secret_seed", "received_at", "course", "student"];

/// The command line. Where the checkout has no solution, it is a student's: what only staff use still works, but is not
/// shown.
fn command_line() -> clap::Command {
    let command = Arguments::command();
    if Workspace::find().is_ok_and(|workspace| workspace.is_staff()) {
        return command;
    }
    let command = STAFF_COMMANDS
        .into_iter()
        .fold(command, |command, name| command.mut_subcommand(name, |staff| staff.hide(true)));
    command.mut_subcommand("grade", |grade| {
        grade.mut_args(|argument| {
            let is_staff = STAFF_OPTIONS.contains(&argument.get_id().as_str());
            if is_staff { argument.hide(true) } else { argument }
        })
    })
}
