//! Archives, read entry by entry and never unpacked to disk.

use std::io::{Cursor, Read};

use flate2::read::MultiGzDecoder;
use zip::ZipArchive;

use super::collect::{Collector, Stop};
use super::names::{self, Kind};
use super::{Note, Refusal, limits};

/// Format of an archive by its first bytes, since names cannot be trusted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Container {
    Zip,
    Gzip,
    Tar,
    Unknown,
}

impl Container {
    pub(super) fn of(bytes: &[u8]) -> Self {
        if bytes.starts_with(b"PK\x03\x04") || bytes.starts_with(b"PK\x05\x06") {
            Self::Zip
        } else if bytes.starts_with(b"\x1f\x8b") {
            Self::Gzip
        } else if bytes.get(257..262) == Some(b"ustar") {
            Self::Tar
        } else {
            Self::Unknown
        }
    }
}

/// Collects the files of an archive that is inside `depth` others.
pub(super) fn collect(
    name: &str,
    bytes: &[u8],
    container: Container,
    depth: usize,
    collector: &mut Collector,
) -> Result<(), Stop> {
    match container {
        Container::Zip => collect_zip(name, bytes, depth, collector),
        Container::Gzip => {
            let mut counted =
                Counted { inner: MultiGzDecoder::new(bytes), unpacked: 0, packed: bytes.len() as u64 };
            let outcome = collect_tar(name, &mut counted, depth, collector);
            collector.count_unpacked(counted.unpacked, counted.packed)?;
            outcome
        }
        Container::Tar => collect_tar(name, &mut &bytes[..], depth, collector),
        Container::Unknown => {
            let why = if bytes.is_empty() { "it is empty" } else { "it is neither zip, tar nor gzip" };
            collector.obstacle(Refusal::BrokenArchive(name.to_owned(), why.to_owned()));
            Ok(())
        }
    }
}

fn collect_zip(name: &str, bytes: &[u8], depth: usize, collector: &mut Collector) -> Result<(), Stop> {
    let broken = |why: String| Refusal::BrokenArchive(name.to_owned(), why);
    let mut archive = match ZipArchive::new(Cursor::new(bytes)) {
        Ok(archive) => archive,
        Err(error) => {
            collector.obstacle(broken(error.to_string()));
            return Ok(());
        }
    };
    for index in 0..archive.len() {
        collector.count_entry()?;
        // Raw: the names of encrypted files can be read without the password.
        let (entry, encrypted, link) = match archive.by_index_raw(index) {
            Ok(file) if file.is_dir() => continue,
            Ok(file) => (text_of_name(file.name_raw()), file.encrypted(), file.is_symlink()),
            Err(error) => {
                collector.obstacle(broken(error.to_string()));
                continue;
            }
        };
        if !is_wanted(&entry, link, collector) {
            continue;
        }
        if encrypted {
            collector.obstacle(Refusal::Encrypted(name.to_owned()));
            continue;
        }
        match archive.by_index(index) {
            Ok(file) => {
                let packed = file.compressed_size();
                let mut counted = Counted { inner: file, unpacked: 0, packed };
                let outcome = collector.offer(&entry, &mut counted, depth + 1);
                collector.count_unpacked(counted.unpacked, counted.packed)?;
                outcome?;
            }
            Err(error) => collector.obstacle(broken(error.to_string())),
        }
    }
    Ok(())
}

fn collect_tar(
    name: &str,
    reader: &mut dyn Read,
    depth: usize,
    collector: &mut Collector,
) -> Result<(), Stop> {
    let mut archive = tar::Archive::new(reader);
    let broken = |why: std::io::Error| Refusal::BrokenArchive(name.to_owned(), why.to_string());
    let entries = match archive.entries() {
        Ok(entries) => entries,
        Err(error) => {
            collector.obstacle(broken(error));
            return Ok(());
        }
    };
    for entry in entries {
        collector.count_entry()?;
        let mut entry = match entry {
            Ok(entry) => entry,
            Err(error) if is_limit(&error) => {
                return Err(collector.stop(Refusal::Bomb(error.to_string())));
            }
            Err(error) => {
                collector.obstacle(broken(error));
                break;
            }
        };
        let kind = entry.header().entry_type();
        let path = text_of_name(&entry.path_bytes());
        if kind.is_dir() || !(kind.is_file() || kind.is_symlink() || kind.is_hard_link()) {
            continue;
        }
        if is_wanted(&path, !kind.is_file(), collector) {
            collector.offer(&path, &mut entry, depth + 1)?;
        }
    }
    Ok(())
}

/// True if an entry is to be read. Links and paths that lead out of the archive are recorded if they would matter.
fn is_wanted(entry: &str, link: bool, collector: &mut Collector) -> bool {
    if !collector.wants(entry) {
        return false;
    }
    let is_source = names::kind(entry) == Kind::Named;
    let refusal = if link {
        Refusal::Link(entry.to_owned())
    } else if names::leads_out(entry) {
        Refusal::OutsidePath(entry.to_owned())
    } else {
        return true;
    };
    if is_source {
        collector.bad_source(refusal);
    } else {
        collector.note(Note::PassedOver(refusal.to_string()));
    }
    false
}

/// Decodes a name: UTF-8, or another encoding as written by old zip programs.
fn text_of_name(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Counts the output of a decompressor, and stops it if that is too much for its input.
struct Counted<R> {
    inner: R,
    unpacked: u64,
    packed: u64,
}

/// Error text by which [`is_limit`] recognizes a reader that was stopped.
const LIMIT: &str = "the stream unpacks to too much";

impl<R: Read> Read for Counted<R> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let dense = self.unpacked > limits::ATTACHMENT && self.unpacked / self.packed.max(1) > limits::RATIO;
        if dense || self.unpacked > limits::UNPACKED {
            return Err(std::io::Error::other(LIMIT));
        }
        let count = self.inner.read(buffer)?;
        self.unpacked += count as u64;
        Ok(count)
    }
}

fn is_limit(error: &std::io::Error) -> bool {
    error.to_string().contains(LIMIT)
}
