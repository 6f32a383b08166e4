//! The files of a handout, and their names in it.

use std::path::{Path, PathBuf};

use super::manifests::{self, Audience};
use harness::assignment::Assignment;
use harness::workspace::Workspace;
use verdict::error::{Error, Result};

/// Files and folders that are included, without tests: some of these need the solution, and some show how to sample a
/// light.
const INCLUDED: [&str; 23] = [
    ".gitattributes",
    ".gitignore",
    ".vscode",
    "LICENSE-APACHE",
    "LICENSE-MIT",
    "assignments/causes.schema.json",
    "assignments/rubric.schema.json",
    "rustfmt.toml",
    "skeleton/.cargo",
    "skeleton/src",
    "skeleton/import/src",
    "skeleton/view/src",
    "grader/src",
    "grader/classroom/src",
    "grader/harness/src",
    "grader/intake/src",
    "grader/judge/src",
    "grader/present/src",
    "grader/verdict/src",
    "grader/host/src",
    "grader/host/program",
    "scenes",
    "references",
];

/// Folders below these that stay with the staff.
const EXCLUDED: [&str; 2] = ["scenes/hidden", "references/hidden"];

/// Test modules in files of their own.
const TEST_FILES: [&str; 2] = ["tests.rs", "test_scenes.rs"];

/// Included files of the assignment. `course.yml` is not: it names students with extensions.
const OF_ASSIGNMENT: [&str; 3] = ["sheet.md", "rubric.yml", "starter.rs"];

/// Files of the assignment that are included if they exist: figures, causes of mistakes and their signatures.
const OPTIONAL: [&str; 4] = ["figures", "causes.yml", "facts.json", "signatures.json"];

/// Files of the assignment that are moved, if they exist.
const MOVED: [(&str, &str); 3] = [
    ("handout.md", "README.md"),
    ("ci/github.yml", ".github/workflows/grade.yml"),
    ("ci/gitlab.yml", ".gitlab-ci.yml"),
];

/// Cargo's files, which name packages that are not included.
type Rewrite = fn(&str, Audience) -> std::result::Result<String, String>;
const REWRITTEN: [(&str, Rewrite); 14] = [
    ("Cargo.toml", manifests::workspace),
    ("Cargo.lock", manifests::lock),
    (".cargo/config.toml", manifests::aliases),
    ("skeleton/Cargo.toml", manifests::without_benches),
    ("skeleton/import/Cargo.toml", manifests::without_benches),
    ("skeleton/view/Cargo.toml", manifests::without_benches),
    ("grader/Cargo.toml", manifests::without_tests),
    ("grader/classroom/Cargo.toml", manifests::without_tests),
    ("grader/harness/Cargo.toml", manifests::without_tests),
    ("grader/host/Cargo.toml", manifests::without_tests),
    ("grader/intake/Cargo.toml", manifests::without_tests),
    ("grader/judge/Cargo.toml", manifests::without_tests),
    ("grader/present/Cargo.toml", manifests::without_tests),
    ("grader/verdict/Cargo.toml", manifests::without_tests),
];

/// Paths and contents of the files for students, sorted by path.
pub(super) fn for_students(
    workspace: &Workspace,
    assignment: &Assignment,
) -> Result<Vec<(PathBuf, Vec<u8>)>> {
    files(workspace, assignment, Audience::Students)
}

fn files(
    workspace: &Workspace,
    assignment: &Assignment,
    audience: Audience,
) -> Result<Vec<(PathBuf, Vec<u8>)>> {
    let root = workspace.root();
    let own = assignment.folder.path();
    let own = own.strip_prefix(root).unwrap_or(own).to_owned();
    let mut files = Vec::new();
    for name in INCLUDED.into_iter().map(PathBuf::from).chain(OF_ASSIGNMENT.map(|name| own.join(name))) {
        collect(root, &name, &mut files)?;
    }
    files.retain(|(path, _)| !EXCLUDED.iter().any(|kept| path.starts_with(kept)));
    for name in OPTIONAL.map(|name| own.join(name)) {
        if root.join(&name).exists() {
            collect(root, &name, &mut files)?;
        }
    }
    for (from, to) in MOVED {
        let from = root.join(&own).join(from);
        if from.is_file() {
            files.push((PathBuf::from(to), read(&from)?));
        }
    }
    for (name, rewrite) in REWRITTEN {
        let path = root.join(name);
        let text = String::from_utf8(read(&path)?).map_err(|error| Error::file(&path, error))?;
        let text = rewrite(&text, audience).map_err(|message| Error::file(&path, message))?;
        files.push((PathBuf::from(name), text.into_bytes()));
    }
    let starter = read(&assignment.folder.starter_file())?;
    replace(&mut files, PathBuf::from(&assignment.rubric.submission.path), starter);
    let overlay = assignment.folder.overlay();
    if overlay.is_dir() {
        let mut others = Vec::new();
        collect(&overlay, Path::new(""), &mut others)?;
        others.into_iter().for_each(|(path, bytes)| replace(&mut files, path, bytes));
    }
    for (path, bytes) in files.iter_mut().filter(|(path, _)| path.starts_with("grader")) {
        if path.extension().is_some_and(|extension| extension == "rs") {
            without_tests(bytes);
        }
    }
    files.sort();
    Ok(files)
}

/// Adds a file, in the place of one that has the same path.
fn replace(files: &mut Vec<(PathBuf, Vec<u8>)>, path: PathBuf, bytes: Vec<u8>) {
    files.retain(|(other, _)| *other != path);
    files.push((path, bytes));
}

/// Removes the test module at the end of a source.
fn without_tests(source: &mut Vec<u8>) {
    const TESTS: &[u8] = b"\n#[cfg(test)]\nmod tests {";
    if let Some(start) = source.windows(TESTS.len()).position(|part| part == TESTS) {
        source.truncate(start);
    }
}

/// The same for the autograder: with the solution, which some checks compare with, and with the scenes of the staff.
pub(super) fn for_grading(workspace: &Workspace, assignment: &Assignment) -> Result<Vec<(PathBuf, Vec<u8>)>> {
    let root = workspace.root();
    let mut files = files(workspace, assignment, Audience::Grading)?;
    for name in ["solution/Cargo.toml", "solution/src", "solution/benches"] {
        collect(root, Path::new(name), &mut files)?;
    }
    let solution = assignment.solution_file();
    let name = solution.strip_prefix(root).unwrap_or(&solution).to_owned();
    replace(&mut files, name, read(&solution)?);
    for name in EXCLUDED.map(Path::new) {
        if root.join(name).is_dir() {
            collect(root, name, &mut files)?;
        }
    }
    Ok(files)
}

/// Adds a file, or all files below a folder, except hidden files and test modules.
fn collect(root: &Path, name: &Path, files: &mut Vec<(PathBuf, Vec<u8>)>) -> Result<()> {
    let path = root.join(name);
    let is_test = name.starts_with("grader") && TEST_FILES.iter().any(|file| name.ends_with(file));
    if is_test {
        return Ok(());
    }
    if !path.is_dir() {
        files.push((name.to_owned(), read(&path)?));
        return Ok(());
    }
    for entry in std::fs::read_dir(&path).map_err(|error| Error::file(&path, error))? {
        let entry = entry.map_err(|error| Error::file(&path, error))?.file_name();
        let hidden = entry.to_string_lossy().starts_with('.') && entry != ".gitattributes";
        if !hidden {
            collect(root, &name.join(entry), files)?;
        }
    }
    Ok(())
}

fn read(path: &Path) -> Result<Vec<u8>> {
    std::fs::read(path).map_err(|error| Error::file(path, error))
}
