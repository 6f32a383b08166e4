//! Exit status and failures.

use std::process::ExitCode;

use crate::diagnostic::Diagnostic;

/// The exit status of the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub(super) enum Exit {
    /// Success.
    Done = 0,
    /// Invalid command line, scene or output file. clap uses the same status.
    Refused = 2,
    /// Internal error, or the algorithm panicked.
    Broken = 3,
    /// Interrupted. Not 0, although an image is saved: it has fewer samples than requested, and a script should be able
    /// to tell. By convention 128 + SIGINT.
    Interrupted = 130,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(exit as u8)
    }
}

/// Why rendering failed.
#[derive(Debug, thiserror::Error)]
pub(super) enum Failure {
    /// A file cannot be read or written.
    #[error(transparent)]
    File(#[from] Diagnostic),
    /// The image has too many pixels.
    #[error("{width} x {height} pixels are too many: the limit is {limit}")]
    TooLarge {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
        /// Maximum number of pixels.
        limit: u64,
    },
    /// The window has another algorithm than this program.
    #[error("--view: the window of `cargo view` shows the student's algorithm; this program has none")]
    Window,
    /// The threads could not be started.
    #[error("could not start the render threads: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
    /// The signal handler could not be installed.
    #[error("could not install the handler for Ctrl-C: {0}")]
    Interrupt(#[from] ctrlc::Error),
    /// The algorithm panicked.
    #[error("the algorithm panicked; see the message above for the location")]
    Panic,
}

impl Failure {
    /// The exit status of the program.
    pub(super) fn exit(&self) -> Exit {
        match self {
            Self::File(_) | Self::TooLarge { .. } | Self::Window => Exit::Refused,
            Self::Threads(_) | Self::Interrupt(_) | Self::Panic => Exit::Broken,
        }
    }
}

/// Prints an answer of clap: a usage error, or the help or version text that was requested.
pub(super) fn answer(answer: &clap::Error) -> ExitCode {
    // A closed pipe is not an error.
    let _ = answer.print();
    let exit = if answer.use_stderr() { Exit::Refused } else { Exit::Done };
    exit.into()
}
