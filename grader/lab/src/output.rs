//! Files that the laboratory writes. A file that cannot be written is an [`Error::Output`]: the input is not to blame.

use std::io::Write;
use std::path::Path;

use verdict::error::{Error, Result};

/// Writes a text file: complete, or not at all.
///
/// # Errors
/// If it cannot be written.
pub fn write_text(path: &Path, text: &str) -> Result<()> {
    arty::image::write_aside(path, |writer| writer.write_all(text.as_bytes()))
        .map_err(|error| Error::Output(error.to_string()))
}

/// Creates a folder and those above it, where they are missing.
///
/// # Errors
/// If it cannot be created.
pub fn create_folder(path: &Path) -> Result<()> {
    std::fs::create_dir_all(path).map_err(|error| failed(path, error))
}

/// The error of a file or folder that cannot be written.
pub(crate) fn failed(path: &Path, error: impl std::fmt::Display) -> Error {
    Error::Output(format!("{}: cannot be written: {error}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failed_write_does_not_blame_the_input() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let file = folder.path().join("file");
        write_text(&file, "text").expect("it can be written");
        for refused in [write_text(&file.join("below"), "text"), create_folder(&file.join("below"))] {
            assert!(matches!(refused, Err(Error::Output(_))), "{refused:?}");
        }
    }
}
