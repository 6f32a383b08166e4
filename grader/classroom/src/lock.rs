//! Locks of result folders, so that two processes never write to one at once.
//!
//! The operating system holds a lock for as long as its process lives: a grader that was killed leaves none behind.

use std::fs::{File, TryLockError};
use std::path::Path;

use verdict::error::{Error, Result};

/// The lock of a folder; given back when it is dropped.
#[derive(Debug)]
pub struct FolderLock {
    _file: File,
}

impl FolderLock {
    /// Takes the lock with which a class is graded into a folder.
    ///
    /// # Errors
    /// [`Error::Input`] if another process holds it; [`Error::Output`] if the folder cannot be locked.
    pub fn of_results(folder: &Path) -> Result<Self> {
        let (path, file) = open(folder, ".lock")?;
        match file.try_lock() {
            Ok(()) => Ok(Self { _file: file }),
            Err(TryLockError::WouldBlock) => Err(Error::file(
                folder,
                "another grader is writing to this folder: wait until it has ended, or use another --out",
            )),
            Err(TryLockError::Error(error)) => Err(Error::output(&path, error)),
        }
    }

    /// Takes the lock of [`Self::of_results`], and waits for it: a scheduler may start a shard again while a machine that
    /// it takes for lost is still at it.
    ///
    /// # Errors
    /// If the folder cannot be locked.
    pub fn of_results_in_turn(folder: &Path) -> Result<Self> {
        let (path, file) = open(folder, ".lock")?;
        file.lock().map_err(|error| Error::output(&path, error))?;
        Ok(Self { _file: file })
    }

    /// Takes the lock of a folder's marks, and waits for it: nobody holds it for long.
    ///
    /// # Errors
    /// If the folder cannot be locked.
    pub(crate) fn of_marks(folder: &Path) -> Result<Self> {
        let (path, file) = open(folder, ".marks.lock")?;
        file.lock().map_err(|error| Error::output(&path, error))?;
        Ok(Self { _file: file })
    }
}

fn open(folder: &Path, name: &str) -> Result<(std::path::PathBuf, File)> {
    let path = folder.join(name);
    let opened = File::options().create(true).truncate(false).write(true).open(&path);
    let file = opened.map_err(|error| Error::output(&path, error))?;
    Ok((path, file))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_second_of_two_is_refused_until_the_first_has_ended() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let first = FolderLock::of_results(folder.path()).expect("it is free");
        let message = FolderLock::of_results(folder.path()).expect_err("it is taken").to_string();
        assert!(message.contains("another grader"), "{message}");
        drop(first);
        FolderLock::of_results(folder.path()).expect("it is free again");
    }
}
