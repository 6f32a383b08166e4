//! `grader completions`.

use std::process::ExitCode;

use clap_complete::Shell;

use present::streams::print;
use verdict::error::Result;

/// Print shell completions for bash, elvish, fish, powershell or zsh
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Shell to print completions for
    shell: Shell,
}

pub(super) fn run(arguments: &Arguments, mut command_line: clap::Command) -> Result<ExitCode> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut command_line, "grader", &mut script);
    print(String::from_utf8_lossy(&script))?;
    Ok(ExitCode::SUCCESS)
}
