//! Output of the laboratory. Output that cannot be written is an [`Error::Output`]: the input is not to blame.

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

/// Writes text to standard output. A reader that has left, such as `head`, is not an error.
///
/// # Errors
/// If it cannot be written.
pub fn print(text: &str) -> Result<()> {
    let mut output = std::io::stdout().lock();
    match output.write_all(text.as_bytes()).and_then(|()| output.flush()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Error::Output(format!("standard output: {error}")))
        }
        _ => Ok(()),
    }
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
