//! The objects of a repository: each in a file of its own, or in a pack.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use flate2::read::ZlibDecoder;

use super::super::budget::{Budget, Metered, Stop};
use super::super::limits;
use super::delta;
use super::pack::{Base, Pack};
use super::{is_file, is_folder};

/// Reason why an object cannot be read.
#[derive(Clone, Copy, Debug)]
pub(super) enum Trouble {
    /// It is missing, or not what git writes.
    Damaged,
    /// It, or something it is made from, is too large.
    TooLarge,
    /// The submission has cost too much.
    Stop(Stop),
}

impl From<Stop> for Trouble {
    fn from(stop: Stop) -> Self {
        Self::Stop(stop)
    }
}

/// Kind of an object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Commit,
    Tree,
    Blob,
}

/// Id of an object: a SHA-1 or a SHA-256.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Id(Vec<u8>);

impl Id {
    pub(super) fn new(bytes: &[u8]) -> Self {
        Self(bytes.to_vec())
    }

    /// Reads hexadecimal digits.
    pub(super) fn parse(text: &str) -> Option<Self> {
        if !matches!(text.len(), 40 | 64) || !text.is_ascii() {
            return None;
        }
        let pairs = (0..text.len()).step_by(2).map(|at| u8::from_str_radix(&text[at..at + 2], 16).ok());
        pairs.collect::<Option<_>>().map(Self)
    }

    pub(super) fn bytes(&self) -> &[u8] {
        &self.0
    }

    /// Length in bytes.
    pub(super) fn length(&self) -> usize {
        self.0.len()
    }
}

/// The objects of a repository.
pub(super) struct Store {
    folder: PathBuf,
    packs: Vec<Pack>,
    budget: Rc<Budget>,
}

/// Maximum number of packs.
const MAX_PACKS: usize = 200;
/// Maximum number of deltas between an object and its base: the largest that git allows.
const MAX_DELTAS: usize = 4095;

impl Store {
    /// Opens the folder `objects`. Packs that cannot be read are skipped.
    pub(super) fn open(folder: &Path, budget: &Rc<Budget>) -> Self {
        let pack_folder = folder.join("pack");
        let mut indices: Vec<PathBuf> = Vec::new();
        if is_folder(&pack_folder) {
            let list = std::fs::read_dir(&pack_folder).into_iter().flatten().flatten();
            let paths =
                list.map(|entry| entry.path()).filter(|path| path.extension().is_some_and(|it| it == "idx"));
            indices.extend(paths.take(MAX_PACKS));
        }
        indices.sort();
        let packs = indices.iter().filter_map(|index| Pack::open(index, budget)).collect();
        Self { folder: folder.to_owned(), packs, budget: Rc::clone(budget) }
    }

    /// Reads an object of a kind, of at most `max` bytes.
    pub(super) fn read(&mut self, id: &Id, kind: Kind, max: u64) -> Result<Vec<u8>, Trouble> {
        let (is, bytes) = self.find(id, max.max(limits::SOURCE))?;
        if is != kind {
            return Err(Trouble::Damaged);
        }
        if bytes.len() as u64 > max { Err(Trouble::TooLarge) } else { Ok(bytes) }
    }

    /// Reads an object and applies its deltas.
    fn find(&mut self, id: &Id, max: u64) -> Result<(Kind, Vec<u8>), Trouble> {
        let mut deltas: Vec<Vec<u8>> = Vec::new();
        let mut left = limits::ATTACHMENT;
        let mut at = Base::Id(id.clone());
        let (kind, mut bytes) = loop {
            if let Base::Id(id) = &at {
                match self.packs.iter().enumerate().find_map(|(index, pack)| Some((index, pack.offset(id)?)))
                {
                    Some((pack, offset)) => at = Base::At { pack, offset },
                    None => break self.read_loose(id, max)?,
                }
            }
            let Base::At { pack, offset } = at else { return Err(Trouble::Damaged) };
            let entry = self.packs[pack].read(offset, id.length(), left.min(max), &self.budget)?;
            match entry.base {
                Ok(kind) => break (kind, entry.bytes),
                Err(base) if deltas.len() < MAX_DELTAS => {
                    left = left.checked_sub(entry.bytes.len() as u64).ok_or(Trouble::TooLarge)?;
                    deltas.push(entry.bytes);
                    at = match base {
                        Base::At { offset, .. } => Base::At { pack, offset },
                        by_id @ Base::Id(_) => by_id,
                    };
                }
                Err(_) => return Err(Trouble::Damaged),
            }
        };
        while let Some(delta) = deltas.pop() {
            bytes = delta::apply(&bytes, &delta, max)?;
            self.budget.bytes(bytes.len() as u64)?;
        }
        Ok((kind, bytes))
    }

    /// Reads an object with a file of its own: `<kind> <size>\0<bytes>`, compressed.
    fn read_loose(&self, id: &Id, max: u64) -> Result<(Kind, Vec<u8>), Trouble> {
        const MAX_HEADER: u64 = 32;
        let hex: String = id.bytes().iter().map(|byte| format!("{byte:02x}")).collect();
        let folder = self.folder.join(&hex[..2]);
        let path = folder.join(&hex[2..]);
        if !is_folder(&folder) || !is_file(&path) {
            return Err(Trouble::Damaged);
        }
        let file = File::open(&path).map_err(|_| Trouble::Damaged)?;
        let bytes = inflate(file, max + MAX_HEADER, &self.budget)?;
        let end = bytes.iter().position(|&byte| byte == 0).ok_or(Trouble::Damaged)?;
        let header = std::str::from_utf8(&bytes[..end]).map_err(|_| Trouble::Damaged)?;
        let kind = match header.split(' ').next() {
            Some("commit") => Kind::Commit,
            Some("tree") => Kind::Tree,
            Some("blob") => Kind::Blob,
            _ => return Err(Trouble::Damaged),
        };
        Ok((kind, bytes[end + 1..].to_vec()))
    }
}

/// Decompresses at most `max` bytes.
pub(super) fn inflate(reader: impl Read, max: u64, budget: &Rc<Budget>) -> Result<Vec<u8>, Trouble> {
    let mut decoder = ZlibDecoder::new(Metered::new(reader, budget));
    match budget.read(&mut decoder, max)? {
        Ok(Some(bytes)) => Ok(bytes),
        Ok(None) => Err(Trouble::TooLarge),
        Err(_) => Err(Trouble::Damaged),
    }
}
