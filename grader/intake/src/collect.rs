//! Collects the relevant files of a submission and selects the source to grade.

use std::collections::BTreeSet;
use std::io::Read;
use std::path::PathBuf;

use super::archive::{self, Container};
use super::explanation::{explanation, is_ordinary};
use super::names::{self, Kind, base};
use super::text::{decode, with_our_line_ends};
use super::{Explanation, Intake, Note, Refusal, limits, md5_of};
use verdict::submission::Submission;

/// A file of a submission.
struct Found {
    name: String,
    bytes: Vec<u8>,
}

/// Reading of a submission was stopped; the reason is in [`Collection::stopped`].
pub(super) struct Stop;

/// Files found so far.
#[derive(Default)]
pub(super) struct Collector {
    named: Vec<Found>,
    other_sources: Vec<Found>,
    explanations: Vec<Explanation>,
    /// Sources that cannot be graded, and why.
    bad_sources: Vec<Refusal>,
    /// Other things that could not be read: a refusal if no source is found, otherwise a note.
    obstacles: Vec<Refusal>,
    /// Why reading was stopped; `None` if it was not.
    fatal: Option<Refusal>,
    notes: Vec<Note>,
    checksums: Vec<String>,
    entries: usize,
    unpacked: u64,
    /// Names of the first files that are not relevant.
    seen: Vec<String>,
}

/// Maximum number of names of other files in the message of a missing source.
const NAMED: usize = 5;

impl Collector {
    /// Counts an entry of a folder, archive or repository.
    pub(super) fn count_entry(&mut self) -> Result<(), Stop> {
        self.entries += 1;
        if self.entries > limits::ENTRIES {
            return Err(self.stop(Refusal::Bomb(format!("more than {} files", limits::ENTRIES))));
        }
        Ok(())
    }

    /// Counts bytes unpacked from a compressed stream of so many bytes.
    pub(super) fn count_unpacked(&mut self, unpacked: u64, packed: u64) -> Result<(), Stop> {
        self.unpacked += unpacked;
        let too_dense = unpacked > limits::ATTACHMENT && unpacked / packed.max(1) > limits::RATIO;
        if self.unpacked > limits::UNPACKED || too_dense {
            return Err(self.stop(Refusal::Bomb(format!("{} bytes out of {packed}", self.unpacked))));
        }
        Ok(())
    }

    /// Stops reading, with a reason.
    pub(super) fn stop(&mut self, refusal: Refusal) -> Stop {
        self.fatal.get_or_insert(refusal);
        Stop
    }

    /// Records something that could not be read.
    pub(super) fn obstacle(&mut self, refusal: Refusal) {
        self.obstacles.push(refusal);
    }

    /// Records a note.
    pub(super) fn note(&mut self, note: Note) {
        self.notes.push(note);
    }

    /// Records the checksum of a file as it was sent.
    pub(super) fn checksum(&mut self, bytes: &[u8]) {
        self.checksums.push(md5_of(bytes));
    }

    /// True if a file of this name is worth opening.
    pub(super) fn wants(&mut self, name: &str) -> bool {
        if names::is_left_behind(name) {
            return false;
        }
        if self.seen.len() < NAMED {
            self.seen.push(name.to_owned());
        }
        names::kind(name) != Kind::Other
    }

    /// Takes a file according to its name. `depth` is the number of archives that it is inside.
    pub(super) fn offer(&mut self, name: &str, reader: &mut dyn Read, depth: usize) -> Result<(), Stop> {
        match names::kind(name) {
            Kind::Named | Kind::OtherSource => self.offer_source(name, reader),
            Kind::Explanation => match read_at_most(reader, limits::ATTACHMENT) {
                Ok(Some(bytes)) => self.explanations.push(explanation(name, &bytes)),
                Ok(None) => self.note(Note::PassedOver(format!("{name} is too large for an explanation"))),
                Err(error) => self.note(Note::PassedOver(format!("{name}: {error}"))),
            },
            Kind::Archive if depth > 1 => self.obstacle(Refusal::NestedArchive(name.to_owned())),
            Kind::Archive => return self.offer_archive(name, reader, depth),
            Kind::UnknownArchive => self.obstacle(Refusal::UnsupportedArchive(name.to_owned())),
            Kind::Other => {}
        }
        Ok(())
    }

    fn offer_archive(&mut self, name: &str, reader: &mut dyn Read, depth: usize) -> Result<(), Stop> {
        let max = if depth == 0 { limits::ARCHIVE } else { limits::ATTACHMENT };
        match read_at_most(reader, max) {
            Ok(Some(bytes)) => {
                if depth == 0 {
                    self.checksum(&bytes);
                }
                return archive::collect(name, &bytes, Container::of(&bytes), depth, self);
            }
            Ok(None) => self.obstacle(Refusal::TooLarge(name.to_owned(), max + 1)),
            Err(error) => self.obstacle(Refusal::BrokenArchive(name.to_owned(), error.to_string())),
        }
        Ok(())
    }

    fn offer_source(&mut self, name: &str, reader: &mut dyn Read) {
        let is_named = names::kind(name) == Kind::Named;
        match read_at_most(reader, limits::SOURCE) {
            Ok(Some(bytes)) => {
                let found = Found { name: name.to_owned(), bytes };
                if is_named { self.named.push(found) } else { self.other_sources.push(found) }
            }
            Ok(None) if is_named => {
                // How much there is of it does no harm to count, and helps to understand.
                let rest =
                    std::io::copy(&mut reader.take(limits::ARCHIVE), &mut std::io::sink()).unwrap_or(0);
                self.bad_sources.push(Refusal::TooLarge(name.to_owned(), limits::SOURCE + 1 + rest));
            }
            Err(error) if is_named => {
                self.bad_sources.push(Refusal::Unreadable(name.to_owned(), error.to_string()));
            }
            Ok(None) | Err(_) => {}
        }
    }

    /// Takes a file as the source, whatever its name.
    pub(super) fn offer_as_source(&mut self, found_under: &str, bytes: Vec<u8>) {
        self.named.push(Found { name: found_under.to_owned(), bytes });
    }

    /// Records a source that cannot be graded.
    pub(super) fn bad_source(&mut self, refusal: Refusal) {
        self.bad_sources.push(refusal);
    }

    /// Selects the source to grade.
    pub(super) fn conclude(mut self, path: PathBuf, starter: &str) -> Intake {
        let outcome = match self.fatal.take() {
            Some(refusal) => Err(refusal),
            None => self.choose(starter).map(|source| Submission { path, source }),
        };
        if outcome.is_ok() {
            let passed_over = self.bad_sources.iter().chain(&self.obstacles);
            self.notes.extend(passed_over.map(|obstacle| Note::PassedOver(obstacle.to_string())));
        }
        // With nothing else to mark, a README may be the explanation.
        if self.explanations.iter().any(|explanation| !is_ordinary(explanation)) {
            self.explanations.retain(|explanation| !is_ordinary(explanation));
        }
        Intake { outcome, notes: self.notes, explanations: self.explanations, checksums: self.checksums }
    }

    fn choose(&mut self, starter: &str) -> Result<String, Refusal> {
        let mut candidates = std::mem::take(&mut self.named);
        let is_starter = |bytes: &[u8]| comparable(bytes).trim() == with_our_line_ends(starter).trim();
        if candidates.iter().all(|found| is_starter(&found.bytes)) && self.bad_sources.is_empty() {
            // Course systems rename files, and so do browsers: render_pt(1).rs, maybe beside the starting file.
            let mut others = std::mem::take(&mut self.other_sources);
            others.retain(|found| is_submission(&found.bytes) && !is_starter(&found.bytes));
            if let Some(first) = others.first() {
                self.notes.push(Note::OtherName(base(&first.name).to_owned()));
            }
            candidates.append(&mut others);
        }
        if candidates.iter().any(|found| !is_starter(&found.bytes)) {
            let passed_over = candidates.iter().filter(|found| is_starter(&found.bytes));
            self.notes.extend(passed_over.map(|found| Note::StarterToo(found.name.clone())));
            candidates.retain(|found| !is_starter(&found.bytes));
        }
        candidates.sort_by(|one, other| one.name.cmp(&other.name));
        let Some(first) = candidates.first() else {
            let mut reasons = std::mem::take(&mut self.bad_sources);
            reasons.append(&mut self.obstacles);
            return Err(reasons
                .into_iter()
                .next()
                .unwrap_or_else(|| Refusal::MissingFile(std::mem::take(&mut self.seen))));
        };
        let distinct: BTreeSet<String> = candidates.iter().map(|found| comparable(&found.bytes)).collect();
        let names = || candidates.iter().map(|found| found.name.clone()).collect();
        if distinct.len() > 1 {
            return Err(Refusal::SeveralCandidates(names()));
        }
        if candidates.len() > 1 {
            self.notes.push(Note::Copies(names()));
        }
        self.checksums.extend(candidates.iter().map(|found| md5_of(&found.bytes)));
        let text = decode(&first.bytes, &mut self.notes)?;
        if is_starter(&first.bytes) {
            self.notes.push(Note::Untouched);
        }
        Ok(text)
    }
}

/// Bytes as text with line ends replaced, for comparisons only.
fn comparable(bytes: &[u8]) -> String {
    with_our_line_ends(&String::from_utf8_lossy(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)))
}

/// True for a file that defines `PathTracer`, as every submission must: other files of the framework only use it.
fn is_submission(bytes: &[u8]) -> bool {
    let part = b"struct PathTracer";
    bytes.windows(part.len()).any(|window| window == part)
}

/// Reads to the end; `None` if there are more than `max` bytes.
pub(super) fn read_at_most(reader: &mut dyn Read, max: u64) -> std::io::Result<Option<Vec<u8>>> {
    let mut bytes = Vec::new();
    reader.take(max + 1).read_to_end(&mut bytes)?;
    Ok((bytes.len() as u64 <= max).then_some(bytes))
}
