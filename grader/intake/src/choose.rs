//! Selects the source to grade among those found.

use std::collections::{BTreeMap, BTreeSet};

use super::content;
use super::names::{self, base};
use super::text::{decode, with_our_line_ends};
use super::{Note, Refusal, Wanted, md5_of};

/// A file that may be the source.
pub(super) struct Found {
    name: String,
    bytes: Vec<u8>,
}

impl Found {
    pub(super) fn new(name: &str, bytes: Vec<u8>) -> Self {
        Self { name: name.to_owned(), bytes }
    }

    /// True if its text is the assignment's starting file.
    fn is_starter(&self, starter: &str) -> bool {
        comparable(&self.bytes).trim() == starter
    }
}

/// All files that may be the source.
#[derive(Default)]
pub(super) struct Candidates {
    /// Those with the right name, or named on the command line.
    pub(super) named: Vec<Found>,
    /// Sources with another name.
    pub(super) other: Vec<Found>,
    /// Sources that cannot be graded, and why.
    pub(super) bad: Vec<Refusal>,
}

/// The source that is graded.
pub(super) struct Chosen {
    /// Text of the source, as UTF-8 without a byte order mark.
    pub(super) text: String,
    /// MD5 of the bytes of all equal copies.
    pub(super) checksums: Vec<String>,
}

impl Candidates {
    /// Selects the source: the one at `picked`, or else the only one that is not the starting file, or the newest
    /// version of it. Leaves what was not selected.
    pub(super) fn choose(
        &mut self,
        wanted: &Wanted,
        picked: Option<&str>,
        notes: &mut Vec<Note>,
    ) -> Result<Chosen, Refusal> {
        let starter = with_our_line_ends(&wanted.starter);
        let starter = starter.trim();
        let is_twice = |bad: &&Refusal| match bad {
            Refusal::TwoEntries(name) => picked.is_none_or(|picked| names::is_at(name, picked)),
            _ => false,
        };
        if let Some(twice) = self.bad.iter().find(is_twice) {
            return Err(twice.clone());
        }
        let candidates = match picked {
            Some(picked) => self.at(picked)?,
            None => self.eligible(wanted, starter, notes)?,
        };
        let Some(first) = candidates.first() else {
            let bad = (!self.bad.is_empty()).then(|| self.bad.remove(0));
            return Err(bad.unwrap_or(Refusal::MissingFile(wanted.file_name.clone(), Vec::new())));
        };
        let distinct: BTreeSet<String> = candidates.iter().map(|found| comparable(&found.bytes)).collect();
        let names: BTreeSet<String> = candidates.iter().map(|found| found.name.clone()).collect();
        if distinct.len() > 1 {
            // No path tells them apart.
            let is_twice = |name: &&Found| candidates.iter().filter(|it| it.name == name.name).count() > 1;
            return Err(match candidates.iter().find(is_twice) {
                Some(twice) => Refusal::TwoEntries(twice.name.clone()),
                None => Refusal::SeveralCandidates(names.into_iter().collect()),
            });
        }
        if candidates.len() > 1 {
            notes.push(Note::Copies(candidates.iter().map(|found| found.name.clone()).collect()));
        }
        let text = decode(&first.bytes, notes)?;
        if first.is_starter(starter) {
            notes.push(Note::Untouched);
        }
        Ok(Chosen { text, checksums: candidates.iter().map(|found| md5_of(&found.bytes)).collect() })
    }

    /// The candidates at a path, whatever they are.
    fn at(&mut self, picked: &str) -> Result<Vec<Found>, Refusal> {
        let mut all: Vec<Found> = std::mem::take(&mut self.named);
        all.append(&mut self.other);
        let names = all.iter().map(|found| found.name.clone()).collect();
        all.retain(|found| names::is_at(&found.name, picked));
        if all.is_empty() {
            return Err(Refusal::NotThere(picked.to_owned(), names));
        }
        self.bad.clear();
        Ok(sorted(all))
    }

    /// Candidates that are left when the starting file, other names and older versions are passed over.
    fn eligible(
        &mut self,
        wanted: &Wanted,
        starter: &str,
        notes: &mut Vec<Note>,
    ) -> Result<Vec<Found>, Refusal> {
        let Wanted { file_name, type_name, .. } = wanted;
        let may_be_source = |found: &Found| content::may_be_source(&found.bytes, type_name);
        let mut candidates = std::mem::take(&mut self.named);
        let mut others = std::mem::take(&mut self.other);
        others.retain(|found| may_be_source(found) && !found.is_starter(starter));
        let is_none = |found: &Found| found.is_starter(starter) || !may_be_source(found);
        if candidates.iter().all(is_none) && self.bad.is_empty() {
            candidates.append(&mut others);
        }
        notes.extend(sorted(others).into_iter().map(|found| Note::OtherSource(found.name)));
        pass_over(&mut candidates, notes, |found| found.is_starter(starter), Note::StarterToo);
        pass_over(
            &mut candidates,
            notes,
            |found| !may_be_source(found),
            |name| Note::NoType(name, type_name.clone()),
        );
        let candidates = newest(candidates, file_name, notes);
        if let Some(renamed) =
            candidates.iter().find(|found| !base(&found.name).eq_ignore_ascii_case(file_name))
            && candidates.len() == 1
        {
            notes.push(Note::OtherName(base(&renamed.name).to_owned(), file_name.clone()));
        }
        Ok(sorted(candidates))
    }
}

/// Removes candidates that are of no use, with a note, unless all of them are.
fn pass_over(
    candidates: &mut Vec<Found>,
    notes: &mut Vec<Note>,
    useless: impl Fn(&Found) -> bool,
    note: impl Fn(String) -> Note,
) {
    if candidates.iter().any(|found| !useless(found)) {
        let out = candidates.extract_if(.., |found| useless(found));
        notes.extend(sorted(out.collect()).into_iter().map(|found| note(found.name)));
    }
}

/// Of several versions in one place, keeps the newest.
fn newest(candidates: Vec<Found>, file_name: &str, notes: &mut Vec<Note>) -> Vec<Found> {
    let mut newest: BTreeMap<String, u32> = BTreeMap::new();
    for (place, number) in candidates.iter().filter_map(|found| names::version(&found.name, file_name)) {
        let highest = newest.entry(place).or_default();
        *highest = number.max(*highest);
    }
    let is_newest = |found: &Found| {
        names::version(&found.name, file_name)
            .is_none_or(|(place, number)| newest.get(&place) == Some(&number))
    };
    let (kept, older): (Vec<Found>, Vec<Found>) = candidates.into_iter().partition(is_newest);
    notes.extend(sorted(older).into_iter().map(|found| Note::OlderVersion(found.name)));
    kept
}

fn sorted(mut found: Vec<Found>) -> Vec<Found> {
    found.sort_by(|one, other| one.name.cmp(&other.name));
    found
}

/// Bytes as text with line ends replaced, for comparisons only.
fn comparable(bytes: &[u8]) -> String {
    with_our_line_ends(&String::from_utf8_lossy(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)))
}
