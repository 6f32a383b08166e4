//! Intake: finds the one source to grade in a file, folder, archive or git repository.
//!
//! [`take`] searches a submission for the file that is [`Wanted`] in any folder, or else for another Rust source that
//! defines its type. Archives are streamed, never unpacked to disk, and nothing in their headers is
//! trusted: everything is counted against [`limits`]. One archive may be inside another, since course systems pack the
//! archives of students again. Of a git repository, the last commit is read without git. A submission that cannot be
//! graded gets a [`Refusal`] with a code; anything odd but harmless becomes a [`Note`]. Texts that are no source are
//! written explanations, which are there with or without a source.
//!
//! [`Reader::Apart`] does the same in a process that has locked itself in, which is how the grader reads submissions.

mod apart;
mod archive;
mod budget;
mod choose;
mod collect;
mod content;
mod explanation;
mod finding;
mod folder;
mod git;
pub mod limits;
mod names;
mod text;
mod wanted;

use std::path::{Path, PathBuf};

use md5::{Digest, Md5};

use verdict::error::{Error, Result};
use verdict::submission::{Explanation, Submission};

pub use apart::{COMMAND, Reader, serve};
pub use finding::{Note, Refusal};
pub use wanted::Wanted;

use collect::Collector;

/// Result of taking in a submission.
#[derive(Clone, Debug)]
pub struct Intake {
    /// The source to grade, or why there is none.
    pub outcome: std::result::Result<Submission, Refusal>,
    /// Anything odd that does not prevent grading.
    pub notes: Vec<Note>,
    /// Written explanations for a tutor to mark; usually one. They are there even if there is no source.
    pub explanations: Vec<Explanation>,
    /// MD5 of each file as it was sent and of the source in it, in hexadecimal: a student may have sent either checksum.
    pub checksums: Vec<String>,
}

/// Takes in a submission: all files, folders and archives that one student sent. `source` picks the source by the end of
/// its path, in archives too; `None` if there is nothing to choose.
///
/// # Errors
/// If a path does not exist. Faults of the submission are in its `outcome`.
pub fn take(paths: &[PathBuf], wanted: &Wanted, source: Option<&str>) -> Result<Intake> {
    check_exist(paths)?;
    let mut collector = Collector::new(wanted);
    for path in paths {
        let several = paths.len() > 1 && path.is_dir();
        let inside = if several { path.file_name().unwrap_or_default().to_string_lossy() } else { "".into() };
        if folder::collect_path(path, &inside, &mut collector).is_err() {
            // The collector knows why.
            break;
        }
    }
    let path = paths.first().cloned().unwrap_or_else(|| (&wanted.file_name).into());
    Ok(collector.conclude(path, source))
}

/// Takes in one file that is in memory, as if it were a submission with this name.
pub fn take_bytes(name: &str, bytes: &[u8], wanted: &Wanted) -> Intake {
    let mut collector = Collector::new(wanted);
    // If it was stopped, the collector knows why.
    let _ = folder::collect_bytes(name, bytes, &mut collector);
    collector.conclude(name.into(), None)
}

/// Reads the source of a submission: a source file with any name, a folder, an archive or a git repository.
///
/// # Errors
/// If it contains nothing to grade.
pub fn read(path: &Path, wanted: &Wanted) -> Result<Submission> {
    Reader::Here.read(path, wanted)
}

fn check_exist(paths: &[PathBuf]) -> Result<()> {
    for path in paths {
        std::fs::symlink_metadata(path).map_err(|error| Error::file(path, error))?;
    }
    Ok(())
}

/// MD5 in lower-case hexadecimal.
pub fn md5_of(bytes: &[u8]) -> String {
    Md5::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests;
