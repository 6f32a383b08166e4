//! Errors of the grader: all failures that are not faults of the submission.

use std::path::Path;
use std::process::ExitCode;

/// Why a command failed, by who can fix it. Faults of a submission are not errors: they are part of its report.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The command line, a scene, a rubric or a reference is wrong: the user of the grader can fix it.
    #[error("{0}")]
    Input(String),
    /// The grader itself or the machine failed.
    #[error("{0}")]
    Harness(String),
    /// A result cannot be written, for example because the disk is full or a folder is read-only.
    #[error("{0}")]
    Output(String),
}

/// A `Result` whose error is not a fault of the submission.
pub type Result<T> = std::result::Result<T, Error>;

impl Error {
    /// An [`Error::Input`] about a file.
    pub fn file(path: &Path, message: impl std::fmt::Display) -> Self {
        Self::Input(format!("{}: {message}", path.display()))
    }

    /// An [`Error::Output`] about a file that cannot be written.
    pub fn output(path: &Path, error: impl std::fmt::Display) -> Self {
        Self::Output(format!("{} cannot be written: {error}", path.display()))
    }

    /// Exit code of the program: 2 for wrong input, 3 otherwise.
    pub fn exit_code(&self) -> ExitCode {
        match self {
            Self::Input(_) => ExitCode::from(2),
            Self::Harness(_) | Self::Output(_) => ExitCode::from(3),
        }
    }
}

impl From<arty::diagnostic::Diagnostic> for Error {
    fn from(diagnostic: arty::diagnostic::Diagnostic) -> Self {
        Self::Input(diagnostic.to_string())
    }
}
