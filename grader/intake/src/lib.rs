//! Intake: finds the one source to grade in a file, folder, archive or git repository.
//!
//! [`take`] searches a submission for files called [`FILE_NAME`] in any folder. Archives are streamed, never unpacked to
//! disk, and nothing in their headers is trusted: everything is counted against [`limits`]. One archive may be inside
//! another, since course systems pack the archives of students again. Of a git repository, the last commit is read
//! without a checkout. A submission that cannot be graded gets a [`Refusal`] with a code; anything odd but harmless
//! becomes a [`Note`].

mod archive;
mod collect;
mod explanation;
mod finding;
mod folder;
mod git;
pub mod limits;
mod names;
mod text;

use std::path::{Path, PathBuf};

use md5::{Digest, Md5};

use verdict::error::{Error, Result};
use verdict::submission::{Explanation, FILE_NAME, Submission};

pub use finding::{Note, Refusal};

use collect::Collector;

/// Result of taking in a submission.
#[derive(Clone, Debug)]
pub struct Intake {
    /// The source to grade, or why there is none.
    pub outcome: std::result::Result<Submission, Refusal>,
    /// Anything odd that does not prevent grading.
    pub notes: Vec<Note>,
    /// Written explanations for a tutor to mark; usually one.
    pub explanations: Vec<Explanation>,
    /// MD5 of each file as it was sent and of the source in it, in hexadecimal: a student may have sent either checksum.
    pub checksums: Vec<String>,
}

/// Takes in a submission: all files, folders and archives that one student sent. `starter` is the text of the starting
/// file, or empty: a file equal to it counts only if there is no other source.
///
/// # Errors
/// If a path does not exist, or git is needed and missing. Faults of the submission are in its `outcome`.
pub fn take(paths: &[PathBuf], starter: &str) -> Result<Intake> {
    let mut collector = Collector::default();
    for path in paths {
        let metadata = std::fs::metadata(path).map_err(|error| Error::file(path, error))?;
        if metadata.is_dir() {
            folder::collect(path, &mut collector)?;
        } else if metadata.is_file() {
            folder::collect_named_file(path, &mut collector);
        } else {
            return Err(Error::file(path, "this is neither a file nor a folder"));
        }
    }
    let path = paths.first().cloned().unwrap_or_else(|| FILE_NAME.into());
    Ok(collector.conclude(path, starter))
}

/// Reads the source of a submission: a source file with any name, a folder, an archive or a git repository.
///
/// # Errors
/// If it contains nothing to grade.
pub fn read(path: &Path) -> Result<Submission> {
    take(&[path.to_owned()], "")?.outcome.map_err(|refusal| Error::file(path, refusal))
}

/// MD5 in lower-case hexadecimal.
pub fn md5_of(bytes: &[u8]) -> String {
    Md5::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests;
