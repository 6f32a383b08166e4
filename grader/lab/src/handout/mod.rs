//! What students get: a checkout of their own, without the solution and without anything that would give it away.
//!
//! It is made from a list of what is given, not of what is kept back, so that a new file of the staff's stays with the
//! staff until somebody decides otherwise. What is on the list is searched for code of the solution all the same.

mod files;
mod gradescope;
mod leaks;
mod manifests;

use std::io::Write;
use std::path::{Path, PathBuf};

use harness::workspace::Workspace;
use verdict::error::{Error, Result};

pub use gradescope::autograder;
pub use leaks::{Leak, Secrets};

/// What was written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Summary {
    /// How many files.
    pub files: usize,
    /// How many bytes in all.
    pub bytes: u64,
}

/// Writes the handout of an assignment to a folder that is not there yet, or empty.
///
/// # Errors
/// If the folder has something in it, if this checkout has no solution to search for, or if a file that would be given
/// holds some of it. Nothing is written then.
pub fn make(workspace: &Workspace, assignment: &str, out: &Path) -> Result<Summary> {
    if std::fs::read_dir(out).is_ok_and(|mut entries| entries.next().is_some()) || out.is_file() {
        return Err(Error::file(out, "is there already: a handout is written to a new folder"));
    }
    let solution = workspace.solution_file();
    let text = std::fs::read_to_string(&solution).map_err(|error| {
        Error::file(&solution, format!("{error} (a handout is made where the solution is)"))
    })?;
    let secrets = Secrets::of(&text).map_err(|message| Error::file(&solution, message))?;
    let given = files::given(workspace, assignment)?;
    for (path, bytes) in &given {
        if let Some(leak) = secrets.find(&String::from_utf8_lossy(bytes)) {
            let message = format!("holds code of the solution, so nothing was written: `{}`", leak.words);
            return Err(Error::Input(format!("{}:{}: {message}", path.display(), leak.line)));
        }
    }
    write(&given, out)?;
    let bytes = given.iter().map(|(_, bytes)| bytes.len() as u64).sum();
    Ok(Summary { files: given.len(), bytes })
}

/// Writes the files aside, and moves their folder to its place once it is complete.
fn write(given: &[(PathBuf, Vec<u8>)], out: &Path) -> Result<()> {
    let beside = out.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let trouble = |error: std::io::Error| Error::file(out, format!("cannot be written: {error}"));
    std::fs::create_dir_all(beside).map_err(trouble)?;
    let aside = tempfile::Builder::new().prefix(".handout-").tempdir_in(beside).map_err(trouble)?;
    // Not the temporary folder itself, which only its owner may enter.
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
