//! Diagnostics about input files.

use std::fmt;
use std::path::{Path, PathBuf};

/// An error or a warning about an input file.
///
/// Displayed as `file:line: message`, which editors and terminals turn into a link.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// The file.
    pub file: PathBuf,
    /// The line, counted from 1; `None` if the message is about the whole file.
    pub line: Option<usize>,
    /// What is wrong, and what was expected.
    pub message: String,
}

impl Diagnostic {
    /// A diagnostic about a line of a file.
    pub fn at(file: &Path, line: usize, message: impl Into<String>) -> Self {
        Self { file: file.to_owned(), line: Some(line), message: message.into() }
    }

    /// A diagnostic about a whole file.
    pub fn about(file: &Path, message: impl Into<String>) -> Self {
        Self { file: file.to_owned(), line: None, message: message.into() }
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:", printable(&self.file.to_string_lossy()))?;
        if let Some(line) = self.line {
            write!(f, "{line}:")?;
        }
        write!(f, " {}", printable(&self.message))
    }
}

/// A text that quotes a file, without what could command a terminal.
fn printable(text: &str) -> String {
    let is_harmless = |character: char| character == '\n' || !character.is_control();
    text.chars().map(|character| if is_harmless(character) { character } else { '\u{fffd}' }).collect()
}

impl std::error::Error for Diagnostic {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_file_is_quoted_with_cannot_command_a_terminal() {
        let quoted =
            Diagnostic::at(Path::new("a\x07.mtl"), 2, "material `\x1b[31mred\u{9b}0m` is defined twice");
        assert_eq!(
            quoted.to_string(),
            "a\u{fffd}.mtl:2: material `\u{fffd}[31mred\u{fffd}0m` is defined twice"
        );
    }
}
