//! Reading input files.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use crate::diagnostic::Diagnostic;

/// The place where an input file is named.
#[derive(Clone, Debug)]
pub(crate) struct Reference {
    /// The file that names it.
    pub(crate) file: PathBuf,
    /// The line, counted from 1, if known.
    pub(crate) line: Option<usize>,
}

impl fmt::Display for Reference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "named in {}", self.file.display())?;
        self.line.map_or(Ok(()), |line| write!(f, ":{line}"))
    }
}

/// A diagnostic about a file that cannot be read, with the place where it is named.
pub(crate) fn unreadable(path: &Path, named: Option<&Reference>, problem: impl fmt::Display) -> Diagnostic {
    match named {
        Some(reference) => Diagnostic::about(path, format!("{problem} ({reference})")),
        None => Diagnostic::about(path, problem.to_string()),
    }
}

/// Checks that `path` is a regular file of at most `max_bytes`, so that reading it terminates.
pub(crate) fn check_readable(
    path: &Path,
    max_bytes: u64,
    named: Option<&Reference>,
) -> Result<(), Diagnostic> {
    let metadata = std::fs::metadata(path).map_err(|error| match error.kind() {
        io::ErrorKind::NotFound => unreadable(path, named, "no such file"),
        _ => unreadable(path, named, format_args!("cannot be read: {error}")),
    })?;
    if metadata.is_dir() {
        return Err(unreadable(path, named, "is a folder, not a file"));
    }
    if !metadata.is_file() {
        return Err(unreadable(path, named, "is not a regular file"));
    }
    if metadata.len() > max_bytes {
        let problem = format!("has {} bytes; at most {max_bytes} are read", metadata.len());
        return Err(unreadable(path, named, problem));
    }
    Ok(())
}

/// Reads a UTF-8 text file of at most `max_bytes`, without its byte order mark.
pub(crate) fn read(path: &Path, max_bytes: u64, named: Option<&Reference>) -> Result<String, Diagnostic> {
    check_readable(path, max_bytes, named)?;
    let bytes = std::fs::read(path)
        .map_err(|error| unreadable(path, named, format_args!("cannot be read: {error}")))?;
    let mut text = String::from_utf8(bytes).map_err(|error| {
        let valid = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let line = valid.iter().filter(|byte| **byte == b'\n').count() + 1;
        Diagnostic::at(path, line, "is not valid UTF-8")
    })?;
    if text.starts_with('\u{feff}') {
        text.drain(..'\u{feff}'.len_utf8());
    }
    Ok(text)
}
