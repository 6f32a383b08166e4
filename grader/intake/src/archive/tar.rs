//! Tar archives, compressed with gzip or not.

use std::io::Read;

use flate2::read::MultiGzDecoder;
use tar::{Archive, EntryType, PaxExtensions};

use super::super::budget::{Metered, Stop};
use super::super::collect::Collector;
use super::super::{Refusal, limits};
use super::wanted;

/// Collects the files of a compressed archive that is inside `depth` others.
pub(super) fn collect_compressed(
    name: &str,
    bytes: &[u8],
    depth: usize,
    collector: &mut Collector,
) -> Result<(), Stop> {
    let packed = bytes.len() as u64;
    // Input is metered as well: there may be much of it without any output.
    let decoder = MultiGzDecoder::new(Metered::new(bytes, &collector.budget()));
    let mut stream = Dense { inner: Metered::new(decoder, &collector.budget()), unpacked: 0, packed };
    let outcome = collect(name, &mut stream, depth, collector);
    if stream.is_too_dense() {
        return Err(collector.budget().exceed(format!("{} bytes out of {packed}", stream.unpacked)));
    }
    outcome
}

/// Collects the files of an archive that is inside `depth` others.
pub(super) fn collect(
    name: &str,
    reader: &mut dyn Read,
    depth: usize,
    collector: &mut Collector,
) -> Result<(), Stop> {
    let mut archive = Archive::new(reader);
    let broken = |why: String| Refusal::BrokenArchive(name.to_owned(), why);
    // Raw: otherwise the library keeps headers of any length in memory.
    let entries = match archive.entries() {
        Ok(entries) => entries.raw(true),
        Err(error) => {
            collector.obstacle(broken(error.to_string()));
            return Ok(());
        }
    };
    // The name of the next entry, where it has a header of its own.
    let mut long_name = None;
    for entry in entries {
        collector.budget().entry()?;
        let mut entry = match entry {
            Ok(entry) => entry,
            Err(error) => {
                collector.obstacle(broken(error.to_string()));
                break;
            }
        };
        let kind = entry.header().entry_type();
        if matches!(kind, EntryType::GNULongName | EntryType::XHeader) {
            match collector.budget().read(&mut entry, limits::HEADER)? {
                Ok(Some(header)) => long_name = name_in(kind, &header).or(long_name),
                Ok(None) => {
                    return Err(collector.budget().exceed("a file name of more than 64 KiB".to_owned()));
                }
                Err(error) => collector.obstacle(broken(error.to_string())),
            }
            continue;
        }
        let path = long_name.take().unwrap_or_else(|| entry.path_bytes().into_owned());
        if !(kind.is_file() || kind.is_symlink() || kind.is_hard_link()) {
            continue;
        }
        if let Some(path) = wanted(name, &path, !kind.is_file(), collector) {
            let left = entry.size();
            collector.offer(&path, &mut Whole { inner: &mut entry, left }, depth + 1)?;
        }
    }
    Ok(())
}

/// Name of the next entry in a header that holds nothing else; `None` if it holds no name.
fn name_in(kind: EntryType, header: &[u8]) -> Option<Vec<u8>> {
    if kind == EntryType::GNULongName {
        return header.split(|&byte| byte == 0).next().map(<[u8]>::to_vec);
    }
    let path = PaxExtensions::new(header).flatten().find(|extension| extension.key_bytes() == b"path")?;
    Some(path.value_bytes().to_vec())
}

/// An entry that fails where the archive ends before it does: half a source is none.
struct Whole<R> {
    inner: R,
    left: u64,
}

impl<R: Read> Read for Whole<R> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let count = self.inner.read(buffer)?;
        if count == 0 && self.left > 0 && !buffer.is_empty() {
            return Err(std::io::ErrorKind::UnexpectedEof.into());
        }
        self.left = self.left.saturating_sub(count as u64);
        Ok(count)
    }
}

/// The output of a decompressor, which ends if it is too much for the input.
struct Dense<R> {
    inner: R,
    unpacked: u64,
    packed: u64,
}

impl<R> Dense<R> {
    fn is_too_dense(&self) -> bool {
        self.unpacked > limits::ATTACHMENT && self.unpacked / self.packed.max(1) > limits::RATIO
    }
}

impl<R: Read> Read for Dense<R> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        if self.is_too_dense() {
            return Err(std::io::Error::other("the stream unpacks to too much"));
        }
        let count = self.inner.read(buffer)?;
        self.unpacked += count as u64;
        Ok(count)
    }
}
