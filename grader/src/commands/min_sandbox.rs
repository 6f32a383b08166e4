//! The sandbox that a grade asks for.

use harness::sandbox::{Level, Limits};

/// The option that says which sandbox is enough.
#[derive(clap::Args)]
pub(super) struct MinSandbox {
    /// Weakest sandbox level to accept (see `grader doctor`) [default: medium for a class, and for one submission if
    /// the environment variable CI is set; otherwise none]
    #[arg(long, value_name = "LEVEL")]
    allow_sandbox: Option<Level>,
}

impl MinSandbox {
    /// Limits for submissions of other people.
    pub(super) fn of_others(&self) -> Limits {
        self.limits(Level::Medium)
    }

    /// Limits for one submission: usually one's own, but in CI somebody else's.
    pub(super) fn of_one(&self) -> Limits {
        let is_ci = std::env::var_os("CI").is_some_and(|value| !value.is_empty() && value != "false");
        self.limits(if is_ci { Level::Medium } else { Level::None })
    }

    fn limits(&self, default: Level) -> Limits {
        Limits { min_level: self.allow_sandbox.unwrap_or(default), ..Limits::default() }
    }
}
