//! Taking in what was sent: from a file, folder, archive or git repository to the one source that is graded.
//!
//! [`take`] looks through a submission for files of the name [`FILE_NAME`], wherever they lie. Archives are streamed,
//! never unpacked to disk, and nothing that they say is believed: all is counted against the limits of [`limits`].
//! One archive may lie in another, since course systems pack the archives of students once more. Of a git repository
//! the last commit counts, read without a checkout. What cannot be graded is a [`Refusal`] with a code, what is odd
//! but harmless is a [`Note`].

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

/// A submission as it was taken in.
#[derive(Clone, Debug)]
pub struct Intake {
    /// What is graded, or why nothing is.
    pub outcome: std::result::Result<Submission, Refusal>,
    /// What is odd, but does not keep it from being graded.
    pub notes: Vec<Note>,
    /// The written explanation, for a person to mark; usually one.
    pub explanations: Vec<Explanation>,
    /// MD5 of each file as it was sent and of the source in it, in hexadecimal: a student may have named either.
    pub checksums: Vec<String>,
}

/// Takes in a submission: all files, folders and archives that one student sent. `starter` is the text of the starting
/// file, which counts only if there is nothing else; it may be empty.
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

/// The source of a submission that somebody named: a source under any name, a folder, an archive or a git repository.
///
/// # Errors
/// If there is nothing to grade in it; [`take`] tells more.
pub fn read(path: &Path) -> Result<Submission> {
    take(&[path.to_owned()], "")?.outcome.map_err(|refusal| Error::file(path, refusal))
}

/// MD5 in hexadecimal, in small letters.
pub fn md5_of(bytes: &[u8]) -> String {
    Md5::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests;
