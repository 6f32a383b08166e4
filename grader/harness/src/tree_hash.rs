//! Hashes of files and folders.

use std::path::Path;

use verdict::error::{Error, Result};

use crate::workspace::Workspace;

/// The crates and settings that can change a verdict, as paths below the checkout. Pages, exports, intake, classes and
/// the lab only show or collect verdicts.
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

/// Parts of `skeleton/src` that no submission is linked with: the student's file and the command line.
const NOT_LINKED: [&str; 3] = ["algorithms", "cli", "main.rs"];

/// Adds to `hasher` everything in the checkout that can change a verdict, except references and the assignment, which
/// have hashes of their own.
///
/// # Errors
/// If a file cannot be read.
pub fn hash_judging(workspace: &Workspace, hasher: &mut blake3::Hasher) -> Result<()> {
    JUDGING.iter().try_for_each(|path| hash_tree(&workspace.root().join(path), &NOT_LINKED, hasher))
}

/// Adds the names and contents of a file, or of all files below a folder, in the order of their names. Files and folders
/// called as in `left_out` are skipped.
///
/// # Errors
/// If a file cannot be read.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hash_depends_on_what_judges_and_on_nothing_else() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let write = |name: &str, text: &str| {
            let path = folder.path().join(name);
            std::fs::create_dir_all(path.parent().expect("it has one")).expect("it can be made");
            std::fs::write(path, text).expect("it can be written");
        };
        for path in JUDGING {
            write(&if path.starts_with("Cargo") { path.to_owned() } else { format!("{path}/file") }, "old");
        }
        write("skeleton/Cargo.toml", "");
        write("grader/verdict/src/check/id.rs", "old");
        write("grader/present/src/words/verdict.rs", "old");
        write("skeleton/src/algorithms/render_pt.rs", "old");
        let workspace = Workspace::open(folder.path()).expect("it has skeleton/ and scenes/");
        let hash = || {
            let mut hasher = blake3::Hasher::new();
            hash_judging(&workspace, &mut hasher).expect("everything is there");
            hasher.finalize()
        };
        let before = hash();
        for path in ["grader/present/src/words/verdict.rs", "skeleton/src/algorithms/render_pt.rs"] {
            write(path, "new");
            assert_eq!(hash(), before, "{path}");
        }
        for path in ["grader/verdict/src/check/id.rs", "grader/judge/file", "scenes/file", "Cargo.lock"] {
            write(path, "new");
            assert_ne!(hash(), before, "{path}");
            write(path, "old");
            assert_eq!(hash(), before, "{path}");
        }
        write("grader/verdict/src/check/added.rs", "");
        assert_ne!(hash(), before, "a file more");
    }
}
