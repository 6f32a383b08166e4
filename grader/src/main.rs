//! The grader as a program.

fn main() -> std::process::ExitCode {
    grader::memory::stay_small();
    grader::commands::run()
}
