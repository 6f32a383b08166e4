//! Standard output and standard error, where a reader may be gone: `… | head` is no reason to fail.

use std::fmt::Display;
use std::io::{self, ErrorKind, Write};

use verdict::error::{Error, Result};

/// Writes a line to standard output.
///
/// # Errors
/// If it cannot be written although somebody may read it: the disk behind it is full.
pub fn print_line(text: impl Display) -> Result<()> {
    print(format!("{text}\n"))
}

/// Writes a text to standard output as it is.
///
/// # Errors
/// As [`print_line`].
pub fn print(text: impl AsRef<str>) -> Result<()> {
    let mut out = io::stdout().lock();
    unless_unread(out.write_all(text.as_ref().as_bytes()).and_then(|()| out.flush()))
}

/// Writes a line to standard error, whether or not anybody reads it.
pub fn note(text: impl Display) {
    let _ = writeln!(io::stderr(), "{text}");
}

/// The result of writing to standard output: no error if nobody reads it any more.
///
/// # Errors
/// Any other failure.
pub fn unless_unread(result: io::Result<()>) -> Result<()> {
    match result {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Error::Output(format!("standard output cannot be written: {error}")))
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_reader_that_is_gone_is_no_error() {
        assert!(unless_unread(Err(ErrorKind::BrokenPipe.into())).is_ok());
        assert!(matches!(unless_unread(Err(ErrorKind::StorageFull.into())), Err(Error::Output(_))));
    }
}
