//! Messages: one line each on standard error.

use std::fmt::Display;
use std::io::{self, Write};

/// Prints an error, which ends the program.
pub(super) fn error(message: impl Display) {
    plain(format_args!("error: {message}"));
}

/// Prints a warning: something that is probably unintended.
pub(super) fn warning(message: impl Display) {
    plain(format_args!("warning: {message}"));
}

/// Prints a note.
pub(super) fn note(message: impl Display) {
    plain(format_args!("note: {message}"));
}

/// Prints a message without a prefix.
pub(super) fn plain(message: impl Display) {
    // `eprintln` panics if the reader has closed the pipe; the image should be saved all the same.
    let _ = writeln!(io::stderr(), "{message}");
}
