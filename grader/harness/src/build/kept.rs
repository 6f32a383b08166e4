//! Cache of built frameworks, shared by all checkouts of a user.
//!
//! Each is in a folder named by the hash of everything it was built from, so that a framework built in another checkout,
//! or before a `cargo clean`, is found without Cargo. A folder is complete once it has its name, and every user of it
//! holds a lock. Of the unused ones only the most recent are kept.

use std::collections::BTreeMap;
use std::fs::{DirEntry, File, OpenOptions};
use std::io::{Error, Result};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use etcetera::BaseStrategy;
use serde::{Deserialize, Serialize};

use super::cargo::Libraries;
use super::scratch::{IN_USE, remove_unused};

/// Maximum number of frameworks that are kept, the one in use included.
const MAX_KEPT: usize = 4;

/// Prefix of folders that are not complete yet.
const BEGUN: &str = "begun-";

/// Cache folder of the user, which may not be writable; `None` if the user has none.
pub(super) fn cache_dir() -> Option<PathBuf> {
    // Root's own folders are closed to the user that a submission is compiled by, if nobody has named another.
    #[cfg(unix)]
    if rustix::process::geteuid().is_root() && std::env::var_os("XDG_CACHE_HOME").is_none() {
        return Some(PathBuf::from("/var/cache/arty/frameworks"));
    }
    Some(etcetera::choose_base_strategy().ok()?.cache_dir().join("arty").join("frameworks"))
}

/// A framework in the cache, locked as long as this lives.
#[derive(Debug)]
pub(super) struct Kept {
    folder: PathBuf,
    contents: Contents,
    in_use: File,
}

/// List of the files in a folder.
#[derive(Debug, Serialize, Deserialize)]
struct Contents {
    arty: PathBuf,
    host: PathBuf,
    /// BLAKE3 of all libraries.
    hashes: BTreeMap<PathBuf, String>,
}

const CONTENTS: &str = "contents.json";
const LIBRARIES: &str = "libraries";

impl Kept {
    /// Looks for a framework; `None` if it is not there or damaged.
    pub(super) fn find(cache_dir: &Path, key: &str) -> Option<Self> {
        let folder = cache_dir.join(key);
        // For both, since some file systems lock for reading only who may read.
        let in_use = OpenOptions::new().read(true).write(true).open(folder.join(IN_USE)).ok()?;
        // Who makes or removes it does not take long.
        in_use.lock_shared().ok()?;
        let contents = serde_json::from_slice(&std::fs::read(folder.join(CONTENTS)).ok()?).ok()?;
        let kept = Self { folder, contents, in_use };
        // So that those used last are known.
        let _ = kept.in_use.set_modified(SystemTime::now());
        kept.is_whole().then_some(kept)
    }

    /// True if all libraries are there, with the content that was kept.
    pub(super) fn is_whole(&self) -> bool {
        let is_same = |name: &PathBuf, hash: &String| {
            hash_of(&self.libraries().join(name)).is_ok_and(|found| found == *hash)
        };
        self.contents.hashes.iter().all(|(name, hash)| is_same(name, hash))
    }

    /// Adds what Cargo has built to the cache, and removes what is damaged or has not been used for long.
    pub(super) fn keep(cache_dir: &Path, key: &str, built: &Libraries) -> Result<()> {
        std::fs::create_dir_all(cache_dir)?;
        let folder = tempfile::Builder::new().prefix(BEGUN).tempdir_in(cache_dir)?;
        open_to_others(folder.path())?;
        let in_use = File::create(folder.path().join(IN_USE))?;
        in_use.try_lock()?;
        std::fs::create_dir(folder.path().join(LIBRARIES))?;
        let mut hashes = BTreeMap::new();
        for library in &built.all {
            let name = name_of(library)?;
            let copy = folder.path().join(LIBRARIES).join(&name);
            // Cargo links its files likewise, and replaces them as a whole.
            std::fs::hard_link(library, &copy).or_else(|_| std::fs::copy(library, &copy).map(drop))?;
            hashes.insert(name, hash_of(&copy)?);
        }
        let contents = Contents { arty: name_of(&built.arty)?, host: name_of(&built.host)?, hashes };
        std::fs::write(folder.path().join(CONTENTS), serde_json::to_vec_pretty(&contents)?)?;
        let place = cache_dir.join(key);
        remove_unused(&place);
        // Windows moves no folder with an open file.
        let in_use = (!cfg!(windows)).then_some(in_use);
        std::fs::rename(folder.path(), &place)?;
        drop(in_use);
        drop(folder.keep());
        remove_old(cache_dir);
        Ok(())
    }

    /// The library `arty`.
    pub(super) fn arty(&self) -> PathBuf {
        self.libraries().join(&self.contents.arty)
    }

    /// The library `host`.
    pub(super) fn host(&self) -> PathBuf {
        self.libraries().join(&self.contents.host)
    }

    /// Folder of both libraries and their dependencies.
    pub(super) fn libraries(&self) -> PathBuf {
        self.folder.join(LIBRARIES)
    }
}

fn hash_of(file: &Path) -> Result<String> {
    let mut hasher = blake3::Hasher::new();
    hasher.update_reader(File::open(file)?)?;
    Ok(hasher.finalize().to_hex().to_string())
}

fn name_of(file: &Path) -> Result<PathBuf> {
    file.file_name().map(PathBuf::from).ok_or_else(|| Error::other("a library without a name"))
}

/// Makes a temporary folder readable for other users.
fn open_to_others(folder: &Path) -> Result<()> {
    #[cfg(unix)]
    std::fs::set_permissions(folder, std::os::unix::fs::PermissionsExt::from_mode(0o755))?;
    let _ = folder;
    Ok(())
}

/// Removes unused frameworks except the most recent ones, and incomplete folders of graders that were killed.
fn remove_old(cache_dir: &Path) {
    let entries = || std::fs::read_dir(cache_dir).into_iter().flatten().flatten();
    let is_begun = |entry: &DirEntry| entry.file_name().to_string_lossy().starts_with(BEGUN);
    let last_use = |folder: &Path| std::fs::metadata(folder.join(IN_USE)).and_then(|file| file.modified());
    let whole = entries().filter(|entry| !is_begun(entry)).map(|entry| entry.path());
    let mut whole: Vec<_> = whole.map(|folder| (last_use(&folder).ok(), folder)).collect();
    whole.sort_by(|a, b| b.cmp(a));
    whole.into_iter().skip(MAX_KEPT).for_each(|(_, folder)| remove_unused(&folder));
    entries().filter(is_begun).for_each(|entry| remove_unused(&entry.path()));
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    /// Two libraries, which say what they are told.
    fn built(folder: &Path, says: &str) -> Libraries {
        let file = |name: &str| {
            let file = folder.join(name);
            std::fs::write(&file, format!("{name}: {says}")).expect("it can be written");
            file
        };
        let (arty, host) = (file("libarty.rlib"), file("libhost.rlib"));
        Libraries { all: vec![arty.clone(), host.clone(), file("libglam.rlib")], arty, host }
    }

    fn keep(cache_dir: &Path, key: &str) -> Result<()> {
        let target = tempfile::tempdir().expect("a temporary folder");
        Kept::keep(cache_dir, key, &built(target.path(), key))
    }

    #[test]
    fn what_is_kept_is_found_with_all_that_it_needs_and_not_under_another_key() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let cache_dir = folder.path().join("of/this/user");
        keep(&cache_dir, "one").expect("it can be kept");
        assert!(Kept::find(&cache_dir, "another").is_none());
        let kept = Kept::find(&cache_dir, "one").expect("it was kept");
        let text = |file: PathBuf| std::fs::read_to_string(file).expect("it is there");
        assert_eq!(text(kept.arty()), "libarty.rlib: one");
        assert_eq!(text(kept.host()), "libhost.rlib: one");
        assert_eq!(text(kept.libraries().join("libglam.rlib")), "libglam.rlib: one");
    }

    #[test]
    fn what_is_damaged_is_not_found_and_is_replaced() {
        for (name, damage) in [
            ("libarty.rlib", Some("cut")),
            ("libglam.rlib", Some("longer than it was")),
            // As long as it was.
            ("libarty.rlib", Some("libarty.rlib: two")),
            ("libglam.rlib", None),
        ] {
            let cache_dir = tempfile::tempdir().expect("a temporary folder");
            keep(cache_dir.path(), "one").expect("it can be kept");
            let file = cache_dir.path().join("one").join(LIBRARIES).join(name);
            match damage {
                Some(text) => std::fs::write(file, text).expect("it can be written"),
                None => std::fs::remove_file(file).expect("it is there"),
            }
            assert!(Kept::find(cache_dir.path(), "one").is_none(), "{name} {damage:?}");
            keep(cache_dir.path(), "one").expect("it can be kept");
            assert!(Kept::find(cache_dir.path(), "one").is_some());
        }
    }

    #[test]
    fn only_the_last_used_stay_and_those_in_use() {
        let cache_dir = tempfile::tempdir().expect("a temporary folder");
        let cache_dir = cache_dir.path();
        let used = |key: &str, seconds: u64| {
            let file =
                OpenOptions::new().write(true).open(cache_dir.join(key).join(IN_USE)).expect("it is there");
            file.set_modified(SystemTime::UNIX_EPOCH + Duration::from_secs(seconds)).expect("it has a time");
        };
        keep(cache_dir, "in use").expect("it can be kept");
        let in_use = Kept::find(cache_dir, "in use");
        used("in use", 0);
        for number in 0..=MAX_KEPT {
            keep(cache_dir, &number.to_string()).expect("it can be kept");
            used(&number.to_string(), 100 - number as u64);
        }
        keep(cache_dir, "last").expect("it can be kept");
        let there = |key: &str| Kept::find(cache_dir, key).is_some();
        assert!(there("in use") && there("0") && there("last"));
        assert!(!there(&MAX_KEPT.to_string()), "the oldest");
        drop(in_use);
        keep(cache_dir, "very last").expect("it can be kept");
        assert_eq!(std::fs::read_dir(cache_dir).expect("it is there").count(), MAX_KEPT);
    }

    #[test]
    fn what_was_begun_by_a_grader_that_is_gone_is_removed() {
        let cache_dir = tempfile::tempdir().expect("a temporary folder");
        let begun = cache_dir.path().join("begun-1");
        std::fs::create_dir(&begun).expect("it can be made");
        let lock = File::create(begun.join(IN_USE)).expect("it can be written");
        lock.lock().expect("nobody else has it");
        keep(cache_dir.path(), "one").expect("it can be kept");
        assert!(begun.exists(), "its grader is still there");
        drop(lock);
        keep(cache_dir.path(), "two").expect("it can be kept");
        assert!(!begun.exists());
    }
}
