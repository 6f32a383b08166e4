//! Folders and single files.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use super::archive::{self, Container};
use super::budget::Stop;
use super::collect::Collector;
use super::names::{self, Kind, shown};
use super::{Refusal, git, limits};

/// Collects a path that was named: a folder, or a file of any name. A link is not followed.
///
/// `inside` is the name in front of all names in it, where several paths were named.
pub(super) fn collect_path(path: &Path, inside: &str, collector: &mut Collector) -> Result<(), Stop> {
    let name = || shown("", &path.file_name().unwrap_or_default().to_string_lossy());
    match std::fs::symlink_metadata(path) {
        Ok(entry) if entry.is_dir() => return collect(path, inside, collector),
        Ok(entry) if entry.is_file() => return collect_named_file(path, &name(), collector),
        Ok(entry) if entry.is_symlink() => collector.bad_source(Refusal::Link(name())),
        Ok(_) => collector.bad_source(Refusal::NoFile(name())),
        Err(error) => collector.bad_source(Refusal::Unreadable(name(), error.to_string())),
    }
    Ok(())
}

/// Collects the files of a folder. A folder with a `.git` counts as its last commit.
fn collect(folder: &Path, inside: &str, collector: &mut Collector) -> Result<(), Stop> {
    let mut waiting = vec![(folder.to_owned(), 0)];
    while let Some((current, depth)) = waiting.pop() {
        let name_of = |path: &Path| {
            let name = path.strip_prefix(folder).unwrap_or(path).to_string_lossy().into_owned();
            (shown(inside, &name), name)
        };
        if let Some(repository) = git::repository_of(&current) {
            git::collect(&repository, &current, &name_of(&current).0, collector)?;
            continue;
        }
        let list = match std::fs::read_dir(&current) {
            Ok(list) => list,
            Err(error) => {
                collector.obstacle(Refusal::Unreadable(name_of(&current).0, error.to_string()));
                continue;
            }
        };
        let mut entries: Vec<PathBuf> = Vec::new();
        for entry in list.flatten() {
            collector.budget().entry()?;
            entries.push(entry.path());
        }
        // The same order on every machine.
        entries.sort();
        for path in entries {
            let Ok(metadata) = std::fs::symlink_metadata(&path) else { continue };
            let (shown, name) = name_of(&path);
            if metadata.is_dir() && depth < limits::DEPTH && !names::is_left_behind(&name) {
                waiting.push((path, depth + 1));
            } else if metadata.is_symlink() && collector.kind(&name) == Kind::Named {
                collector.bad_source(Refusal::Link(shown));
            } else if metadata.is_file() && collector.wants(&name) {
                collect_file(&path, &shown, collector)?;
            }
        }
    }
    Ok(())
}

fn collect_file(path: &Path, name: &str, collector: &mut Collector) -> Result<(), Stop> {
    match File::open(path) {
        Ok(mut file) => collector.offer(name, &mut file, 0),
        Err(error) => {
            collector.obstacle(Refusal::Unreadable(name.to_owned(), error.to_string()));
            Ok(())
        }
    }
}

/// Collects one file that was named: an archive, an explanation, or a source with any name.
fn collect_named_file(path: &Path, name: &str, collector: &mut Collector) -> Result<(), Stop> {
    match File::open(path) {
        Ok(mut file) => collect_named(name, &mut file, collector),
        Err(error) => {
            collector.bad_source(Refusal::Unreadable(name.to_owned(), error.to_string()));
            Ok(())
        }
    }
}

/// Collects bytes as if they were a file that was named.
pub(super) fn collect_bytes(name: &str, mut bytes: &[u8], collector: &mut Collector) -> Result<(), Stop> {
    collect_named(&shown("", name), &mut bytes, collector)
}

fn collect_named(name: &str, reader: &mut dyn Read, collector: &mut Collector) -> Result<(), Stop> {
    let is_rust = match collector.kind(name) {
        Kind::Named | Kind::OtherSource => true,
        Kind::Other => false,
        _ => return collector.offer(name, reader, 0),
    };
    let mut start = Vec::new();
    if let Err(error) = reader.take(512).read_to_end(&mut start) {
        collector.bad_source(Refusal::Unreadable(name.to_owned(), error.to_string()));
        return Ok(());
    }
    // An archive may have lost its extension.
    let is_archive = !is_rust && Container::of(&start) != Container::Unknown;
    let max = if is_archive { limits::ARCHIVE } else { limits::SOURCE };
    match collector.budget().read(&mut start.chain(reader), max)? {
        Ok(Some(bytes)) if is_archive => {
            collector.checksum(&bytes);
            return archive::collect(name, &bytes, 0, collector);
        }
        // Course systems without folders put pictures and tables beside the source.
        Ok(Some(bytes)) if is_rust || collector.is_source(&bytes) => {
            return collector.offer_as_source(name, bytes);
        }
        Ok(None) if is_rust => collector.bad_source(Refusal::TooLarge { name: name.to_owned(), max }),
        Err(error) => collector.bad_source(Refusal::Unreadable(name.to_owned(), error.to_string())),
        Ok(_) => {
            // Named among what there is instead of a source.
            collector.wants(name);
        }
    }
    Ok(())
}
