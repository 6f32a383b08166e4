//! The grader as a program: it composes what the crates below it do.

mod commands;
mod memory;

fn main() -> std::process::ExitCode {
    memory::stay_small();
    commands::run()
}
