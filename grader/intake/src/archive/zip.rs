//! Zip archives.

use std::collections::BTreeSet;
use std::io::Cursor;

use zip::result::ZipError;
use zip::{CompressionMethod, ZipArchive};

use super::super::budget::Stop;
use super::super::collect::Collector;
use super::super::names::{self, Kind};
use super::super::{Refusal, limits};
use super::wanted;

/// Collects the files of an archive that is inside `depth` others.
pub(super) fn collect(name: &str, bytes: &[u8], depth: usize, collector: &mut Collector) -> Result<(), Stop> {
    let broken = |why: String| Refusal::BrokenArchive(name.to_owned(), why);
    // The library reads the whole directory at once, so that it is measured before.
    if count_of(DIRECTORY_ENTRY, bytes) > limits::ENTRIES {
        return Err(collector.budget().exceed(format!("more than {} files", limits::ENTRIES)));
    }
    collector.budget().bytes(bytes.len() as u64)?;
    let mut archive = match ZipArchive::new(Cursor::new(bytes)) {
        Ok(archive) => archive,
        Err(error) => {
            collector.obstacle(broken(error.to_string()));
            return Ok(());
        }
    };
    let start = usize::try_from(archive.central_directory_start()).unwrap_or(usize::MAX);
    for twice in named_twice(bytes.get(start..).unwrap_or_default()) {
        if collector.kind(&twice) == Kind::Named {
            collector.bad_source(Refusal::TwoEntries(names::shown(name, &twice)));
        }
    }
    for index in 0..archive.len() {
        collector.budget().entry()?;
        // Raw: the names of encrypted files can be read without the password.
        let (entry, encrypted, link, method) = match archive.by_index_raw(index) {
            Ok(file) if file.is_dir() => continue,
            Ok(file) => (file.name_raw().to_vec(), file.encrypted(), file.is_symlink(), file.compression()),
            Err(error) => {
                collector.obstacle(broken(error.to_string()));
                continue;
            }
        };
        collector.budget().bytes(entry.len() as u64)?;
        let Some(entry) = wanted(name, &entry, link, collector) else { continue };
        if encrypted {
            collector.obstacle(Refusal::Encrypted(name.to_owned()));
            continue;
        }
        if !matches!(method, CompressionMethod::Stored | CompressionMethod::Deflated) {
            collector.obstacle(Refusal::UnsupportedArchive(name.to_owned()));
            continue;
        }
        match archive.by_index(index) {
            Ok(mut file) => collector.offer(&entry, &mut file, depth + 1)?,
            Err(ZipError::UnsupportedArchive(_)) => {
                collector.obstacle(Refusal::UnsupportedArchive(name.to_owned()));
            }
            Err(error) => collector.obstacle(broken(error.to_string())),
        }
    }
    Ok(())
}

/// First bytes of an entry of the directory at the end of an archive.
const DIRECTORY_ENTRY: &[u8; 4] = b"PK\x01\x02";

fn count_of(mark: &[u8; 4], bytes: &[u8]) -> usize {
    bytes.windows(mark.len()).filter(|window| window == mark).count()
}

/// Names that occur more than once in the directory: the library returns the last entry of each, other programs the
/// first.
fn named_twice(mut directory: &[u8]) -> BTreeSet<String> {
    const FIXED: usize = 46;
    let mut seen = BTreeSet::new();
    let mut twice = BTreeSet::new();
    while directory.starts_with(DIRECTORY_ENTRY) {
        let length = |at: usize| match directory.get(at..at + 2) {
            Some(&[low, high]) => usize::from(u16::from_le_bytes([low, high])),
            _ => 0,
        };
        let end_of_name = FIXED + length(28);
        let Some(name) = directory.get(FIXED..end_of_name) else { break };
        if !seen.insert(name) {
            twice.insert(String::from_utf8_lossy(name).into_owned());
        }
        directory = directory.get(end_of_name + length(30) + length(32)..).unwrap_or_default();
    }
    twice
}
