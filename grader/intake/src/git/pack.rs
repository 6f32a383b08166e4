//! Packs: many objects in one file, some of them as differences from others. An index of version 2 says where they are.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;
use std::rc::Rc;

use super::super::budget::Budget;
use super::super::limits;
use super::is_file;
use super::objects::{Id, Kind, Trouble, inflate};

/// A pack and its index.
pub(super) struct Pack {
    file: File,
    index: Vec<u8>,
}

/// Place of an object that a delta is applied to.
#[derive(Clone, Debug)]
pub(super) enum Base {
    /// In a pack of the store, at this offset in bytes.
    At { pack: usize, offset: u64 },
    /// Anywhere.
    Id(Id),
}

/// An entry of a pack.
pub(super) struct Entry {
    /// Kind of the object; or, if the bytes are a delta, what to apply it to. The number of the pack is not set.
    pub(super) base: Result<Kind, Base>,
    pub(super) bytes: Vec<u8>,
}

/// First bytes of an index, and its version.
const MAGIC: &[u8] = b"\xfftOc\0\0\0\x02";
/// Length in bytes of the table that counts ids by their first byte.
const FAN_OUT: usize = 256 * 4;

impl Pack {
    /// Opens the pack of an index; `None` if it cannot be read.
    pub(super) fn open(index: &Path, budget: &Rc<Budget>) -> Option<Self> {
        let pack = index.with_extension("pack");
        if !is_file(index) || !is_file(&pack) {
            return None;
        }
        let index = budget.read(&mut File::open(index).ok()?, limits::ATTACHMENT).ok()?.ok()??;
        index.starts_with(MAGIC).then_some(())?;
        Some(Self { file: File::open(pack).ok()?, index })
    }

    /// Offset of an object in the pack; `None` if it is not in it.
    pub(super) fn offset(&self, id: &Id) -> Option<u64> {
        let table = self.index.get(MAGIC.len()..)?;
        let number = |at: usize| -> Option<u32> {
            Some(u32::from_be_bytes(table.get(at..at.checked_add(4)?)?.try_into().ok()?))
        };
        let count = number(FAN_OUT - 4)? as usize;
        let first = usize::from(*id.bytes().first()?);
        let mut low = if first == 0 { 0 } else { number(4 * (first - 1))? as usize };
        let mut high = (number(4 * first)? as usize).min(count);
        let length = id.length();
        let place = loop {
            if low >= high {
                return None;
            }
            let middle = low.midpoint(high);
            let start = FAN_OUT.checked_add(middle.checked_mul(length)?)?;
            match table.get(start..start.checked_add(length)?)?.cmp(id.bytes()) {
                std::cmp::Ordering::Less => low = middle + 1,
                std::cmp::Ordering::Greater => high = middle,
                std::cmp::Ordering::Equal => break middle,
            }
        };
        // After the ids come a checksum for each, then offsets, then offsets of more than 31 bits.
        let offsets = FAN_OUT.checked_add(count.checked_mul(length + 4)?)?;
        let offset = number(offsets.checked_add(4 * place)?)?;
        if offset & (1 << 31) == 0 {
            return Some(u64::from(offset));
        }
        let large = offsets.checked_add(4 * count)?.checked_add(8 * (offset & !(1 << 31)) as usize)?;
        Some(u64::from_be_bytes(table.get(large..large.checked_add(8)?)?.try_into().ok()?))
    }

    /// Reads the entry at an offset, of at most `max` bytes.
    pub(super) fn read(
        &mut self,
        offset: u64,
        id_length: usize,
        max: u64,
        budget: &Rc<Budget>,
    ) -> Result<Entry, Trouble> {
        let damaged = |_| Trouble::Damaged;
        self.file.seek(SeekFrom::Start(offset)).map_err(damaged)?;
        let mut reader = std::io::BufReader::new(&self.file);
        let mut next = || -> Result<u8, Trouble> {
            let mut byte = [0];
            reader.read_exact(&mut byte).map_err(damaged)?;
            Ok(byte[0])
        };
        let first = next()?;
        let (kind, mut last, mut size, mut shift) = ((first >> 4) & 7, first, u64::from(first & 15), 4);
        while last & 128 != 0 {
            last = next()?;
            size |= u64::from(last & 127).checked_shl(shift).ok_or(Trouble::Damaged)?;
            shift += 7;
        }
        let base = match kind {
            1 => Ok(Kind::Commit),
            2 => Ok(Kind::Tree),
            3 => Ok(Kind::Blob),
            6 => {
                let mut last = next()?;
                let mut back = u64::from(last & 127);
                while last & 128 != 0 {
                    last = next()?;
                    back = (back + 1).checked_mul(128).ok_or(Trouble::Damaged)? | u64::from(last & 127);
                }
                let offset = offset.checked_sub(back).filter(|_| back > 0).ok_or(Trouble::Damaged)?;
                Err(Base::At { pack: 0, offset })
            }
            7 => {
                let mut id = vec![0; id_length];
                for byte in &mut id {
                    *byte = next()?;
                }
                Err(Base::Id(Id::new(&id)))
            }
            _ => return Err(Trouble::Damaged),
        };
        if size > max {
            return Err(Trouble::TooLarge);
        }
        Ok(Entry { base, bytes: inflate(reader, size, budget)? })
    }
}
