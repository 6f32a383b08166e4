//! Temporary folders of submissions, and removal of those that interrupted graders have left behind.
//!
//! A grader that is killed removes nothing. So each folder holds a file that its grader keeps locked: if it can be locked,
//! the folder is unused. Process numbers would not tell, since they differ between containers.

use std::fs::{File, OpenOptions};
use std::io::Result;
use std::path::Path;
use std::sync::{Arc, Once};
use std::time::Duration;

use tempfile::TempDir;

use crate::sandbox::Account;
use verdict::error::{self, Error};

/// Prefix of the names of the folders.
const PREFIX: &str = "arty-submission-";

/// The file that is locked while the folder is in use.
pub(super) const IN_USE: &str = "in-use";

/// Minimum age at which a folder without that file counts as left behind: younger ones may still be in the making.
const SURELY_LEFT: Duration = Duration::from_secs(3600);

/// A temporary folder that is removed when this is dropped.
#[derive(Debug)]
pub(super) struct Scratch {
    folder: TempDir,
    _in_use: File,
    account: Arc<Account>,
}

/// Minimum free space in the folder for temporary files, in bytes: several times what a submission's program and the
/// linker's files take. With less, a correct submission may not compile.
const MIN_SPACE: u64 = 64 << 20;

/// Refuses a folder for temporary files that is nearly full, before that is taken for a fault of a submission.
fn require_space(folder: &Path) -> error::Result<()> {
    #[cfg(unix)]
    if let Ok(system) = rustix::fs::statvfs(folder) {
        let free = system.f_bavail.saturating_mul(system.f_frsize);
        if free < MIN_SPACE {
            return Err(Error::Harness(format!(
                "the folder for temporary files, {}, has {} MB left, and {} MB are needed: free some, or set TMPDIR to \
                 another folder",
                folder.display(),
                free >> 20,
                MIN_SPACE >> 20
            )));
        }
    }
    let _ = folder;
    Ok(())
}

impl Scratch {
    /// Makes a folder and takes a user id for it. The first call removes folders of interrupted graders.
    pub(super) fn new() -> error::Result<Self> {
        require_space(&std::env::temp_dir())?;
        let account = Arc::new(Account::take()?);
        Self::of(account).map_err(|error| Error::Harness(format!("no temporary folder: {error}")))
    }

    fn of(account: Arc<Account>) -> Result<Self> {
        static ONCE: Once = Once::new();
        ONCE.call_once(|| remove_left_behind(&std::env::temp_dir()));
        let mut builder = tempfile::Builder::new();
        // Nobody but its user may look into it, whatever the grader's own mask of modes.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o700));
        let folder = builder.prefix(PREFIX).tempdir()?;
        let in_use = File::create(folder.path().join(IN_USE))?;
        // A file system without locks leaves more behind, and works otherwise.
        let _ = in_use.try_lock();
        Ok(Self { folder, _in_use: in_use, account })
    }

    /// Gives the folder and its files to its user; only root can read it, too.
    pub(super) fn hand_over(&self) -> error::Result<()> {
        self.account.own(self.path())
    }

    /// User of the folder.
    pub(super) fn account(&self) -> &Arc<Account> {
        &self.account
    }

    /// Path of the folder.
    pub(super) fn path(&self) -> &Path {
        self.folder.path()
    }
}

/// Removes unused folders, except those of other users.
fn remove_left_behind(parent: &Path) {
    for entry in std::fs::read_dir(parent).into_iter().flatten().flatten() {
        let is_folder = entry.file_type().is_ok_and(|kind| kind.is_dir());
        if is_folder && entry.file_name().to_string_lossy().starts_with(PREFIX) {
            remove_unused(&entry.path());
        }
    }
}

/// Removes a folder if it is unused, and locks it meanwhile.
pub(super) fn remove_unused(folder: &Path) {
    let file = folder.join(IN_USE);
    // A pipe of that name would not be opened before somebody writes to it.
    let lock = if std::fs::symlink_metadata(&file).is_ok_and(|metadata| metadata.is_file()) {
        let Ok(file) = OpenOptions::new().read(true).write(true).open(&file) else { return };
        if file.try_lock().is_err() {
            return;
        }
        Some(file)
    } else {
        let made = std::fs::metadata(folder).and_then(|metadata| metadata.modified());
        if !made.is_ok_and(|time| time.elapsed().is_ok_and(|age| age > SURELY_LEFT)) {
            return;
        }
        None
    };
    let _ = std::fs::remove_dir_all(folder);
    drop(lock);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_of_the_dead_are_removed_and_those_of_the_living_are_not() {
        let parent = tempfile::tempdir().expect("a temporary folder");
        let make = |name: &str| {
            let folder = parent.path().join(name);
            std::fs::create_dir(&folder).expect("it can be made");
            let file = File::create(folder.join(IN_USE)).expect("it can be written");
            (folder, file)
        };
        let (living, lock) = make("arty-submission-1");
        lock.lock().expect("nobody else has it");
        let (dead, _) = make("arty-submission-2");
        let (other, _) = make("something-else");
        let begun = parent.path().join("arty-submission-3");
        std::fs::create_dir(&begun).expect("it can be made");
        remove_left_behind(parent.path());
        let there = [&living, &dead, &other, &begun].map(|folder| folder.exists());
        assert_eq!(there, [true, false, true, true]);
    }
}
