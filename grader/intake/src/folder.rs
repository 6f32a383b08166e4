//! Folders and single files.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use super::archive::{self, Container};
use super::collect::{Collector, Stop, read_at_most};
use super::names::{self, Kind};
use super::{Refusal, git, limits};
use verdict::error::Result;

/// Collects the files of a folder. A folder with a `.git` counts as its last commit.
///
/// # Errors
/// If git is needed and missing.
pub(super) fn collect(folder: &Path, collector: &mut Collector) -> Result<()> {
    let mut waiting = vec![(folder.to_owned(), 0)];
    while let Some((current, depth)) = waiting.pop() {
        if let Some(repository) = git::repository_of(&current) {
            if git::collect(&repository, &current, collector)?.is_err() {
                return Ok(());
            }
            continue;
        }
        let mut entries: Vec<PathBuf> = match std::fs::read_dir(&current) {
            Ok(entries) => entries.filter_map(|entry| entry.ok().map(|entry| entry.path())).collect(),
            Err(error) => {
                collector.obstacle(Refusal::Unreadable(name_in(folder, &current), error.to_string()));
                continue;
            }
        };
        // The same order on every machine.
        entries.sort();
        for path in entries {
            let Ok(metadata) = std::fs::symlink_metadata(&path) else { continue };
            if collector.count_entry().is_err() {
                return Ok(());
            }
            let name = name_in(folder, &path);
            if metadata.is_dir() && depth < limits::DEPTH && !names::is_left_behind(&name) {
                waiting.push((path, depth + 1));
            } else if metadata.is_symlink() && names::kind(&name) == Kind::Named {
                collector.bad_source(Refusal::Link(name));
            } else if metadata.is_file() && collect_file(&path, &name, collector).is_err() {
                return Ok(());
            }
        }
    }
    Ok(())
}

fn collect_file(path: &Path, name: &str, collector: &mut Collector) -> std::result::Result<(), Stop> {
    if !collector.wants(name) {
        return Ok(());
    }
    match File::open(path) {
        Ok(mut file) => collector.offer(name, &mut file, 0),
        Err(error) => {
            collector.obstacle(Refusal::Unreadable(name.to_owned(), error.to_string()));
            Ok(())
        }
    }
}

/// Collects one file given by its path: an archive, an explanation, or a source with any name.
pub(super) fn collect_named_file(path: &Path, collector: &mut Collector) {
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let unreadable = |error: std::io::Error| Refusal::Unreadable(name.clone(), error.to_string());
    let read = |max| File::open(path).and_then(|mut file| read_at_most(&mut file, max));
    let kind = names::kind(&name);
    if matches!(kind, Kind::Archive | Kind::UnknownArchive | Kind::Explanation) {
        // Stopping is remembered by the collector, and there is nothing after this file.
        let _ = collect_file(path, &name, collector);
        return;
    }
    let size = std::fs::metadata(path).map_or(0, |metadata| metadata.len());
    let mut start = [0; 512];
    let length = File::open(path).and_then(|mut file| file.read(&mut start)).unwrap_or(0);
    let container = Container::of(&start[..length]);
    let is_archive = container != Container::Unknown && kind == Kind::Other;
    match read(if is_archive { limits::ARCHIVE } else { limits::SOURCE }) {
        Ok(Some(bytes)) if is_archive => {
            collector.checksum(&bytes);
            let _ = archive::collect(&name, &bytes, container, 0, collector);
        }
        Ok(Some(bytes)) => collector.offer_as_source(&name, bytes),
        Ok(None) => collector.bad_source(Refusal::TooLarge(name.clone(), size)),
        Err(error) => collector.bad_source(unreadable(error)),
    }
}

/// A path relative to the submission's folder.
fn name_in(folder: &Path, path: &Path) -> String {
    path.strip_prefix(folder).unwrap_or(path).to_string_lossy().into_owned()
}
