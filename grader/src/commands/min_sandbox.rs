//! How good a sandbox has to be.

use harness::sandbox::{Level, Limits};

/// The option that says how good a sandbox has to be.
#[derive(clap::Args)]
pub(super) struct MinSandbox {
    /// Grade although the sandbox is no better than this (see `grader doctor`) [default: medium for a class, and for
    /// one submission where CI is set; otherwise none]
    #[arg(long, value_name = "LEVEL")]
    allow_sandbox: Option<Level>,
}

impl MinSandbox {
    /// The limits for submissions of others.
    pub(super) fn of_others(&self) -> Limits {
        Limits { min_level: self.allow_sandbox.unwrap_or(Level::Medium), ..Limits::default() }
    }

    /// The limits for the file that somebody names: usually their own, but in CI that of others.
    pub(super) fn of_one(&self) -> Limits {
        let in_ci = std::env::var_os("CI").is_some_and(|value| !value.is_empty() && value != "false");
        let least = if in_ci { Level::Medium } else { Level::None };
        Limits { min_level: self.allow_sandbox.unwrap_or(least), ..Limits::default() }
    }
}
