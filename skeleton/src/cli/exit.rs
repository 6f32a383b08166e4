//! What a run ends with.

use std::process::ExitCode;

use crate::diagnostic::Diagnostic;

/// The exit status of the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub(super) enum Exit {
    /// What was asked for is there.
    Done = 0,
    /// The command line, the scene or a place for the picture is wrong. clap ends with the same status.
    Refused = 2,
    /// The program itself failed, or the algorithm panicked.
    Broken = 3,
    /// Someone interrupted. Not 0, though a picture is saved: it is not the one that was asked for, and a script
    /// that goes on with it should know. 128 + SIGINT is what shells expect of an interrupted program.
    Interrupted = 130,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(exit as u8)
    }
}

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
pub(super) enum Failure {
    /// A file cannot be read or written.
    #[error(transparent)]
    File(#[from] Diagnostic),
    /// The picture would have too many pixels.
    #[error("{width} x {height} pixels are too many: at most {limit} fit into memory and files")]
    TooLarge {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
        /// The most pixels.
        limit: u64,
    },
    /// The threads cannot be started.
    #[error("the threads for rendering cannot be started: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
    /// Interruptions cannot be caught.
    #[error("interruptions (Ctrl-C) cannot be caught: {0}")]
    Interrupt(#[from] ctrlc::Error),
    /// The algorithm panicked.
    #[error("the algorithm panicked; the message above says where")]
    Panic,
}

impl Failure {
    /// What the program ends with.
    pub(super) fn exit(&self) -> Exit {
        match self {
            Self::File(_) | Self::TooLarge { .. } => Exit::Refused,
            Self::Threads(_) | Self::Interrupt(_) | Self::Panic => Exit::Broken,
        }
    }
}

/// Prints what clap has to say: an error, or the help or version that was asked for.
pub(super) fn answer(answer: &clap::Error) -> ExitCode {
    // Whoever closed the other end of a pipe does not want to read it.
    let _ = answer.print();
    let exit = if answer.use_stderr() { Exit::Refused } else { Exit::Done };
    exit.into()
}
