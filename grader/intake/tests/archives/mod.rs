//! Archives as an attacker writes them, byte by byte.

#![allow(dead_code, reason = "each test uses some of them")]

use std::io::Write;

use flate2::Compression;
use flate2::write::{DeflateEncoder, GzEncoder};

/// A source that may be graded.
pub(crate) const SOURCE: &[u8] = b"pub struct PathTracer;\n";

/// An entry of a zip archive, as it is claimed to be.
#[derive(Clone, Default)]
pub(crate) struct Entry {
    /// Name.
    pub(crate) name: Vec<u8>,
    /// Bytes that are stored or compressed.
    pub(crate) bytes: Vec<u8>,
    /// Compression method; 0 stores, 8 deflates.
    pub(crate) method: u16,
    /// Unix mode of the file.
    pub(crate) mode: u32,
    /// Size before compression, if it is a lie.
    pub(crate) claimed: Option<u32>,
}

impl Entry {
    /// A compressed file.
    pub(crate) fn new(name: impl AsRef<[u8]>, bytes: &[u8]) -> Self {
        Self {
            name: name.as_ref().to_vec(),
            bytes: bytes.to_vec(),
            method: 8,
            mode: 0o100_644,
            claimed: None,
        }
    }

    fn packed(&self) -> Vec<u8> {
        if self.method != 8 {
            return self.bytes.clone();
        }
        let mut encoder = DeflateEncoder::new(Vec::new(), Compression::best());
        encoder.write_all(&self.bytes).expect("it can be written");
        encoder.finish().expect("it can be finished")
    }

    /// The fields that local header and directory share.
    fn fields(&self, packed: &[u8]) -> Vec<u8> {
        let mut crc = flate2::Crc::new();
        crc.update(&self.bytes);
        let size = self.claimed.unwrap_or(self.bytes.len() as u32);
        let mut out = [20, 0, self.method, 0, 0].map(u16::to_le_bytes).concat();
        out.extend([crc.sum(), packed.len() as u32, size].map(u32::to_le_bytes).concat());
        out.extend([self.name.len() as u16, 0].map(u16::to_le_bytes).concat());
        out
    }

    fn directory(&self, packed: &[u8], offset: u32) -> Vec<u8> {
        let mut out = b"PK\x01\x02\x14\x03".to_vec();
        out.extend(self.fields(packed));
        out.extend([0, 0, 0].map(u16::to_le_bytes).concat());
        out.extend([self.mode << 16, offset].map(u32::to_le_bytes).concat());
        out.extend(&self.name);
        out
    }
}

/// A zip archive of these entries. Two may have one name.
pub(crate) fn zip(entries: &[Entry]) -> Vec<u8> {
    let (mut out, mut directory) = (Vec::new(), Vec::new());
    for entry in entries {
        let packed = entry.packed();
        directory.extend(entry.directory(&packed, out.len() as u32));
        out.extend(b"PK\x03\x04");
        out.extend(entry.fields(&packed));
        out.extend(&entry.name);
        out.extend(&packed);
    }
    finish(out, &directory, entries.len())
}

/// A zip archive in which many entries of the directory share one stream.
pub(crate) fn overlapping(names: impl Iterator<Item = String>, bytes: &[u8]) -> Vec<u8> {
    let first = Entry::new("a", bytes);
    let packed = first.packed();
    let mut out = b"PK\x03\x04".to_vec();
    out.extend(first.fields(&packed));
    out.extend(b"a");
    out.extend(&packed);
    let mut directory = Vec::new();
    let mut count = 0;
    for name in names {
        directory.extend(Entry { name: name.into(), ..first.clone() }.directory(&packed, 0));
        count += 1;
    }
    finish(out, &directory, count)
}

/// Appends the directory and the end of the archive, with 64-bit numbers where there are too many entries.
fn finish(mut out: Vec<u8>, directory: &[u8], count: usize) -> Vec<u8> {
    let start = out.len() as u64;
    out.extend(directory);
    let end = out.len() as u64;
    let few = u16::try_from(count).ok();
    if few.is_none() {
        out.extend(b"PK\x06\x06");
        out.extend(44_u64.to_le_bytes());
        out.extend([45, 45].map(u16::to_le_bytes).concat());
        out.extend([0_u8; 8]);
        out.extend([count as u64, count as u64, end - start, start].map(u64::to_le_bytes).concat());
        out.extend(b"PK\x06\x07\0\0\0\0");
        out.extend(end.to_le_bytes());
        out.extend(1_u32.to_le_bytes());
    }
    out.extend(b"PK\x05\x06\0\0\0\0");
    out.extend([few.unwrap_or(u16::MAX); 2].map(u16::to_le_bytes).concat());
    out.extend([(end - start) as u32, start as u32].map(u32::to_le_bytes).concat());
    out.extend([0, 0]);
    out
}

/// A header of a tar archive.
pub(crate) fn tar_header(name: &[u8], size: u64, kind: tar::EntryType) -> tar::Header {
    let mut header = tar::Header::new_gnu();
    let field = &mut header.as_gnu_mut().expect("it is of this kind").name;
    field[..name.len()].copy_from_slice(name);
    header.set_size(size);
    header.set_mode(0o644);
    header.set_entry_type(kind);
    header.set_cksum();
    header
}

/// A tar archive of these entries.
pub(crate) fn tar(entries: &[(tar::Header, &[u8])]) -> Vec<u8> {
    let mut out = Vec::new();
    for (header, bytes) in entries {
        out.extend(header.as_bytes());
        out.extend(*bytes);
        out.resize(out.len().next_multiple_of(512), 0);
    }
    out.resize(out.len() + 1024, 0);
    out
}

/// A compressed tar archive whose only header claims a name of so many MiB, made of `block`.
pub(crate) fn long_name(kind: tar::EntryType, mebibytes: u64, block: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
    let header = tar_header(b"././@LongLink", mebibytes << 20, kind);
    encoder.write_all(header.as_bytes()).expect("it can be written");
    for _ in 0..(mebibytes << 20) / block.len() as u64 {
        encoder.write_all(block).expect("it can be written");
    }
    let source = tar_header(b"render_pt.rs", SOURCE.len() as u64, tar::EntryType::Regular);
    encoder.write_all(&tar(&[(source, SOURCE)])).expect("it can be written");
    encoder.finish().expect("it can be finished")
}

/// Compressed bytes.
pub(crate) fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(bytes).expect("it can be written");
    encoder.finish().expect("it can be finished")
}
