//! Archives, read entry by entry and never unpacked to disk.

mod tar;
mod zip;

use super::budget::Stop;
use super::collect::Collector;
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
pub(super) fn collect(name: &str, bytes: &[u8], depth: usize, collector: &mut Collector) -> Result<(), Stop> {
    match Container::of(bytes) {
        Container::Zip => zip::collect(name, bytes, depth, collector),
        Container::Gzip => tar::collect_compressed(name, bytes, depth, collector),
        Container::Tar => tar::collect(name, &mut &bytes[..], depth, collector),
        Container::Unknown => {
            let why = if bytes.is_empty() { "it is empty" } else { "it is neither zip, tar nor gzip" };
            collector.obstacle(Refusal::BrokenArchive(name.to_owned(), why.to_owned()));
            Ok(())
        }
    }
}

/// The name under which an entry is collected; `None` if it is not to be read. Links and paths that lead out of the
/// archive are recorded if they would matter.
fn wanted(archive: &str, entry: &[u8], link: bool, collector: &mut Collector) -> Option<String> {
    if entry.len() > limits::NAME {
        let why = format!("a name of {} bytes", entry.len());
        collector.obstacle(Refusal::BrokenArchive(archive.to_owned(), why));
        return None;
    }
    let entry = &*String::from_utf8_lossy(entry);
    if !collector.wants(entry) {
        return None;
    }
    let name = names::shown(archive, entry);
    let refusal = if link {
        Refusal::Link(name)
    } else if names::leads_out(entry) {
        Refusal::OutsidePath(name)
    } else {
        return Some(name);
    };
    if collector.kind(entry) == Kind::Named {
        collector.bad_source(refusal);
    } else {
        collector.note(Note::PassedOver(refusal.to_string()));
    }
    None
}
