//! The grader as a program.

fn main() -> std::process::ExitCode {
    grader::commands::run()
}
