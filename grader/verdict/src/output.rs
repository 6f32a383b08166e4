//!
//! Writing result files.
//!
//! Failures are [`Error::Output`] and name the file: a full disk or a read-only folder is not a wrong input.

use std::fmt::Display;
use std::fs::File;
use std::io::{BufWriter, ErrorKind, Write};
use std::path::Path;

use serde::Serialize;

use crate::error::{Error, Result};

/// Writes a temporary file and renames it to `path` once it is complete, so that no reader sees half of it.
///
/// # Errors
/// If it cannot be written. An earlier file at `path` is left unchanged.
pub fn write<E: Display>(
    path: &Path,
    content: impl FnOnce(&mut BufWriter<&File>) -> std::result::Result<(), E>,
) -> Result<()> {
    arty::image::write_aside(path, content).map_err(|diagnostic| Error::Output(diagnostic.to_string()))
}

/// Writes bytes or text to a file.
///
/// # Errors
/// As [`write()`].
pub fn write_bytes(path: &Path, bytes: impl AsRef<[u8]>) -> Result<()> {
    write(path, |writer| writer.write_all(bytes.as_ref()))
}

/// Writes a value to a JSON file.
///
/// # Errors
/// As [`write()`].
pub fn write_json(path: &Path, value: &impl Serialize) -> Result<()> {
    write(path, |writer| serde_json::to_writer_pretty(writer, value))
}

/// Removes a file if it exists.
///
/// # Errors
/// If it exists and cannot be removed.
pub fn remove(path: &Path) -> Result<()> {
    match std::fs::remove_file(path) {
        Err(error) if error.kind() != ErrorKind::NotFound => Err(Error::output(path, error)),
        _ => Ok(()),
    }
}

/// Creates a folder and its parents unless they exist.
///
/// # Errors
/// [`Error::Input`] if a file is in the way, since another path avoids that; [`Error::Output`] otherwise.
pub fn create_folder(path: &Path) -> Result<()> {
    std::fs::create_dir_all(path).map_err(|error| match error.kind() {
        ErrorKind::AlreadyExists | ErrorKind::NotADirectory => Error::file(path, error),
        _ => Error::output(path, error),
    })
}

/// Checks whether [`write()`] can write to `path`, before the work of computing its content. Creates no file and changes
/// none.
///
/// # Errors
/// [`Error::Input`] if the parent folder is missing or `path` is a folder; [`Error::Output`] if the folder cannot be
/// written to.
pub fn check_writable(path: &Path) -> Result<()> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let is_possible = !path.is_dir() && folder.is_none_or(Path::is_dir);
    arty::image::check_writable(path).map_err(|diagnostic| {
        let message = diagnostic.to_string();
        if is_possible { Error::Output(message) } else { Error::Input(message) }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_impossible_path_is_an_input_error_and_a_failed_write_is_an_output_error() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let file = folder.path().join("file");
        write_json(&file, &[1, 2]).expect("it can be written");
        assert!(matches!(create_folder(&file), Err(Error::Input(_))));
        assert!(matches!(check_writable(folder.path()), Err(Error::Input(_))));
        assert!(matches!(check_writable(&folder.path().join("no/file")), Err(Error::Input(_))));
        check_writable(&file).expect("it can be replaced");
        let Err(Error::Output(message)) = write(&file, |_| Err("the disk is full")) else {
            panic!("it must fail")
        };
        assert!(message.contains("file") && message.contains("the disk is full"), "{message}");
        assert!(
            std::fs::read_to_string(&file).is_ok_and(|text| text.contains('2')),
            "the earlier file stays"
        );
    }
}
