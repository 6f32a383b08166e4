//! The user id of one submission, which no other submission has at the same time.

use std::fs::{DirBuilder, File, OpenOptions};
use std::os::unix::fs::{DirBuilderExt, MetadataExt, chown};
use std::path::{Path, PathBuf};

use super::user::{self, User};
use verdict::error::{Error, Result};

/// User that one submission is compiled and run as. No other submission has its id as long as this lives.
#[derive(Debug)]
pub(crate) struct Account {
    /// `None` where submissions run as the same user as the grader.
    id: Option<u32>,
    _lock: Option<File>,
}

impl Account {
    /// Takes an id that no grader of this machine uses; the grader's own if it is not root.
    ///
    /// # Errors
    /// If the ids cannot be locked, or if all are in use.
    pub(crate) fn take() -> Result<Self> {
        if super::Machine::here().user != User::Other {
            return Ok(Self { id: None, _lock: None });
        }
        let folder = locks()?;
        let trouble = |error: std::io::Error| Error::Harness(format!("{}: {error}", folder.display()));
        let first = user::first_id();
        for id in first..first + user::IDS {
            // A lock ends with its grader, however that ends. Files stay: removing one would let two have the same id.
            let file =
                OpenOptions::new().create(true).truncate(false).write(true).open(folder.join(id.to_string()));
            let file = file.map_err(trouble)?;
            match file.try_lock() {
                Ok(()) => return Ok(Self { id: Some(id), _lock: Some(file) }),
                Err(std::fs::TryLockError::WouldBlock) => {}
                Err(std::fs::TryLockError::Error(error)) => return Err(trouble(error)),
            }
        }
        Err(Error::Harness(format!("all {} user ids for submissions are in use", user::IDS)))
    }

    /// The user id; `None` if it is the grader's.
    pub(super) fn id(&self) -> Option<u32> {
        self.id
    }

    /// Makes the user the owner of a folder and its files.
    ///
    /// # Errors
    /// If the owner cannot be changed.
    pub(crate) fn own(&self, folder: &Path) -> Result<()> {
        let Some(id) = self.id else { return Ok(()) };
        let trouble = |error| Error::Harness(format!("{}: {error}", folder.display()));
        for entry in std::fs::read_dir(folder).map_err(trouble)? {
            let file = entry.map_err(trouble)?.path();
            chown(file, Some(id), Some(id)).map_err(trouble)?;
        }
        chown(folder, Some(id), Some(id)).map_err(trouble)
    }
}

/// Folder of the locks, which only root can write to.
fn locks() -> Result<PathBuf> {
    let is_root_s = |folder: &Path| {
        std::fs::symlink_metadata(folder)
            .is_ok_and(|found| found.is_dir() && found.uid() == 0 && found.mode() & 0o077 == 0)
    };
    let places = [PathBuf::from("/run"), std::env::temp_dir()].map(|place| place.join("arty-user-ids"));
    let found = places.iter().find(|folder| {
        let _ = DirBuilder::new().mode(0o700).create(folder);
        is_root_s(folder)
    });
    found.cloned().ok_or_else(|| {
        let [first, second] = places.each_ref().map(|folder| folder.display().to_string());
        Error::Harness(format!(
            "no folder for the locks of user ids: neither {first} nor {second} is root's alone"
        ))
    })
}
