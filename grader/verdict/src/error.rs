//! What can go wrong that is not the submission's doing.

use std::path::Path;
use std::process::ExitCode;

/// A reason to stop, with whose matter it is. Faults of a submission are no errors: they are findings in its report.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The command line, a scene, a rubric, a reference: something that the one who runs the grader can mend.
    #[error("{0}")]
    Input(String),
    /// The grader itself or the machine.
    #[error("{0}")]
    Harness(String),
    /// A result that cannot be written: a full disk, a read-only folder.
    #[error("{0}")]
    Output(String),
}

/// A result whose failure is not the submission's doing.
pub type Result<T> = std::result::Result<T, Error>;

impl Error {
    /// An input error about a file.
    pub fn file(path: &Path, message: impl std::fmt::Display) -> Self {
        Self::Input(format!("{}: {message}", path.display()))
    }

    /// The exit status that tells scripts which of the two it is.
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
