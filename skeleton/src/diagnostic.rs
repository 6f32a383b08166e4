//! What is wrong with an input file, and where.

use std::fmt;
use std::path::{Path, PathBuf};

/// One thing to say about an input file: an error if loading stopped at it, else a warning.
///
/// Shown as `file:line: message`, which editors and terminals turn into a link.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// The file it is about.
    pub file: PathBuf,
    /// The line in that file, counted from 1, where one line is to blame.
    pub line: Option<usize>,
    /// What is wrong, and what was expected instead.
    pub message: String,
}

impl Diagnostic {
    /// A diagnostic about a line of a file.
    pub fn at(file: &Path, line: usize, message: impl Into<String>) -> Self {
        Self { file: file.to_owned(), line: Some(line), message: message.into() }
    }

    /// A diagnostic about a file as a whole.
    pub fn about(file: &Path, message: impl Into<String>) -> Self {
        Self { file: file.to_owned(), line: None, message: message.into() }
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:", self.file.display())?;
        if let Some(line) = self.line {
            write!(f, "{line}:")?;
        }
        write!(f, " {}", self.message)
    }
}

impl std::error::Error for Diagnostic {}
