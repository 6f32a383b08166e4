//! Hashes of files and folders.

use std::path::Path;

use verdict::error::{Error, Result};

use crate::workspace::Workspace;

/// The crates and settings that can change a verdict, as paths below the checkout. Everything else (pages, exports,
/// intake, classes, the laboratory) only shows or collects what these decide.
const JUDGING: [&str; 8] = [
    "Cargo.lock",
    "Cargo.toml",
    "skeleton/src",
    "grader/host",
    "grader/verdict",
    "grader/harness",
    "grader/judge",
    "scenes",
];

/// Parts of `skeleton/src` that no grade is linked with: the student's file and the command line.
const NOT_LINKED: [&str; 3] = ["algorithms", "cli", "main.rs"];

/// Adds everything below the checkout that can change a verdict, references and assignment aside.
///
/// # Errors
/// If a file cannot be read.
pub fn hash_judging(workspace: &Workspace, hasher: &mut blake3::Hasher) -> Result<()> {
    JUDGING.iter().try_for_each(|path| hash_tree(&workspace.root().join(path), &NOT_LINKED, hasher))
}

/// Adds a file, or all files below a folder, but for files and folders with one of the names to be left out.
pub fn hash_tree(path: &Path, left_out: &[&str], hasher: &mut blake3::Hasher) -> Result<()> {
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
