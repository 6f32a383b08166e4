//! Talk: one line each, on the error stream.

use std::fmt::Display;
use std::io::{self, Write};

/// Something that made the program give up.
pub(super) fn error(message: impl Display) {
    plain(format_args!("error: {message}"));
}

/// Something that is probably not meant.
pub(super) fn warning(message: impl Display) {
    plain(format_args!("warning: {message}"));
}

/// Something that is good to know.
pub(super) fn note(message: impl Display) {
    plain(format_args!("note: {message}"));
}

/// What is going on.
pub(super) fn plain(message: impl Display) {
    // Not `eprintln`, which panics if nobody reads any more: that must not cost the picture.
    let _ = writeln!(io::stderr(), "{message}");
}
