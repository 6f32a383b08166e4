//! Hashes of files and folders.

use std::path::Path;

use crate::error::{Error, Result};

/// Folders of what neither makes nor judges an image, for [`hash_tree`].
pub(crate) const NOT_JUDGING: [&str; 15] = [
    "algorithms",
    "calibration",
    "class",
    "cli",
    "commands",
    "convergence",
    "diagnosis",
    "export",
    "handout",
    "image_error",
    "intake",
    "mutants",
    "pictures",
    "policy",
    "report",
];

/// Adds a file, or all files below a folder, but for files and folders with one of the names to be left out.
pub(crate) fn hash_tree(path: &Path, left_out: &[&str], hasher: &mut blake3::Hasher) -> Result<()> {
    let name = path.file_name().unwrap_or_default();
    let trouble = |error: std::io::Error| Error::file(path, error);
    if left_out.iter().any(|&other| name == other) {
        return Ok(());
    }
    if !path.is_dir() {
        hasher.update(name.as_encoded_bytes());
        hasher.update(blake3::hash(&std::fs::read(path).map_err(trouble)?).as_bytes());
        return Ok(());
    }
    let mut entries = std::fs::read_dir(path)
        .map_err(trouble)?
        .map(|entry| entry.map(|entry| entry.path()))
        .collect::<std::io::Result<Vec<_>>>()
        .map_err(trouble)?;
    entries.sort();
    entries.iter().try_for_each(|entry| hash_tree(entry, left_out, hasher))
}
