//! The handout: a checkout for students, without the solution and everything that reveals it.
//!
//! It is made from a list of what is included, not of what is excluded: a new file stays with the staff until somebody
//! adds it to the list. The included files are searched for code of the solution all the same.

mod files;
mod gradescope;
mod leaks;
mod manifests;

use std::io::Write;
use std::path::{Path, PathBuf};

use crate::output::failed;
use harness::assignment::Assignment;
use harness::workspace::Workspace;
use serde::Deserialize;
use verdict::error::{Error, Result};

pub use gradescope::autograder;
pub use leaks::{Leak, Secrets};

/// Size of a handout.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Summary {
    /// Number of files.
    pub files: usize,
    /// Total size in bytes.
    pub bytes: u64,
}

/// Writes the handout of an assignment to a folder that is missing or empty.
///
/// # Errors
/// If the folder is not empty, this checkout has no solution to search for, or a file of the handout holds code of the
/// solution. Nothing is written then.
pub fn make(workspace: &Workspace, assignment: &Assignment, out: &Path) -> Result<Summary> {
    if std::fs::read_dir(out).is_ok_and(|mut entries| entries.next().is_some()) || out.is_file() {
        return Err(Error::file(out, "exists already: choose a new or empty folder"));
    }
    let secrets = secrets(assignment)?;
    let given = files::for_students(workspace, assignment)?;
    for (path, bytes) in &given {
        if let Some(leak) = secrets.find(&String::from_utf8_lossy(bytes)) {
            let message = format!("contains code of the solution, so nothing was written: `{}`", leak.words);
            return Err(Error::Input(format!("{}:{}: {message}", path.display(), leak.line)));
        }
    }
    write(&given, out)?;
    let bytes = given.iter().map(|(_, bytes)| bytes.len() as u64).sum();
    Ok(Summary { files: given.len(), bytes })
}

/// Contents of `leaks.yml`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct LeaksFile {
    public: Vec<String>,
}

/// What must not be in a handout of the assignment.
///
/// # Errors
/// If this checkout has no solution, or the solution does not differ from the starting file.
pub fn secrets(assignment: &Assignment) -> Result<Secrets> {
    let file = assignment.solution_file();
    if !assignment.has_solution() {
        return Err(Error::file(&file, "a handout can only be made in a checkout with the solution"));
    }
    let leaks = assignment.folder.leaks_file();
    let public = if leaks.is_file() { arty::yaml::read::<LeaksFile>(&leaks)?.0.public } else { Vec::new() };
    Secrets::of(&assignment.solution()?, &assignment.folder.starter()?, &public)
        .map_err(|message| Error::file(&file, message))
}

/// Writes the files to a temporary folder, and renames that once it is complete.
fn write(given: &[(PathBuf, Vec<u8>)], out: &Path) -> Result<()> {
    let beside = out.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let trouble = |error: std::io::Error| failed(out, error);
    std::fs::create_dir_all(beside).map_err(trouble)?;
    let aside = tempfile::Builder::new().prefix(".handout-").tempdir_in(beside).map_err(trouble)?;
    // A folder below it: the temporary folder is accessible to its owner only.
    let folder = aside.path().join("handout");
    for (path, bytes) in given {
        let path = folder.join(path);
        std::fs::create_dir_all(path.parent().unwrap_or(&folder)).map_err(trouble)?;
        std::fs::File::create(&path).and_then(|mut file| file.write_all(bytes)).map_err(trouble)?;
    }
    if out.is_dir() {
        std::fs::remove_dir(out).map_err(trouble)?;
    }
    std::fs::rename(&folder, out).map_err(trouble)
}
