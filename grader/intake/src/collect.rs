//! Collects the relevant files of a submission.

use std::io::Read;
use std::path::PathBuf;
use std::rc::Rc;

use super::archive;
use super::budget::{Budget, Stop};
use super::choose::{Candidates, Found};
use super::content;
use super::explanation::{explanation, is_ordinary};
use super::names::{self, Kind};
use super::{Explanation, Intake, Note, Refusal, Wanted, limits, md5_of};
use verdict::submission::Submission;

/// Files found so far.
pub(super) struct Collector {
    wanted: Wanted,
    candidates: Candidates,
    explanations: Vec<Explanation>,
    /// Other things that could not be read: a refusal if no source is found, otherwise a note.
    obstacles: Vec<Refusal>,
    notes: Vec<Note>,
    checksums: Vec<String>,
    budget: Rc<Budget>,
    /// Names of the first files that are not relevant.
    seen: Vec<String>,
}

/// Maximum number of names of other files in the message of a missing source.
const NAMED: usize = 5;

impl Collector {
    pub(super) fn new(wanted: &Wanted) -> Self {
        Self {
            wanted: wanted.clone(),
            candidates: Candidates::default(),
            explanations: Vec::new(),
            obstacles: Vec::new(),
            notes: Vec::new(),
            checksums: Vec::new(),
            budget: Budget::new(),
            seen: Vec::new(),
        }
    }

    /// Kind of a file by its name.
    pub(super) fn kind(&self, name: &str) -> Kind {
        names::kind(name, &self.wanted.file_name)
    }

    /// True for a text that is Rust and defines the type of a submission.
    pub(super) fn is_source(&self, bytes: &[u8]) -> bool {
        content::is_source(bytes, &self.wanted.type_name)
    }

    /// What reading the submission may cost.
    pub(super) fn budget(&self) -> Rc<Budget> {
        Rc::clone(&self.budget)
    }

    /// Records something that could not be read.
    pub(super) fn obstacle(&mut self, refusal: Refusal) {
        if self.obstacles.len() < limits::NOTES {
            self.obstacles.push(refusal);
        }
    }

    /// Records a note. Beyond a number that anybody reads, they are dropped.
    pub(super) fn note(&mut self, note: Note) {
        if self.notes.len() < limits::NOTES {
            self.notes.push(note);
        }
    }

    /// Records the checksum of a file as it was sent.
    pub(super) fn checksum(&mut self, bytes: &[u8]) {
        self.checksums.push(md5_of(bytes));
    }

    /// Records a source that cannot be graded.
    pub(super) fn bad_source(&mut self, refusal: Refusal) {
        if self.candidates.bad.len() < limits::NOTES {
            self.candidates.bad.push(refusal);
        }
    }

    /// True if a file of this name is worth opening.
    pub(super) fn wants(&mut self, name: &str) -> bool {
        if names::is_left_behind(name) {
            return false;
        }
        if self.seen.len() < NAMED {
            self.seen.push(names::shown("", name));
        }
        self.kind(name) != Kind::Other
    }

    /// Takes a file according to its name, as [`names::shown`]. `depth` is the number of archives that it is inside.
    pub(super) fn offer(&mut self, name: &str, reader: &mut dyn Read, depth: usize) -> Result<(), Stop> {
        match self.kind(name) {
            Kind::Named | Kind::OtherSource => self.offer_source(name, reader, depth),
            Kind::Text | Kind::Explanation => self.offer_text(name, reader),
            Kind::Archive if depth > 1 => {
                self.obstacle(Refusal::NestedArchive(name.to_owned()));
                Ok(())
            }
            Kind::Archive => self.offer_archive(name, reader, depth),
            Kind::UnknownArchive => {
                self.obstacle(Refusal::UnsupportedArchive(name.to_owned()));
                Ok(())
            }
            Kind::Other => Ok(()),
        }
    }

    fn offer_archive(&mut self, name: &str, reader: &mut dyn Read, depth: usize) -> Result<(), Stop> {
        let max = if depth == 0 { limits::ARCHIVE } else { limits::ATTACHMENT };
        match self.budget().read(reader, max)? {
            Ok(Some(bytes)) => {
                if depth == 0 {
                    self.checksum(&bytes);
                }
                return archive::collect(name, &bytes, depth, self);
            }
            Ok(None) => self.obstacle(Refusal::TooLarge { name: name.to_owned(), max }),
            Err(error) => self.obstacle(Refusal::BrokenArchive(name.to_owned(), error.to_string())),
        }
        Ok(())
    }

    fn offer_text(&mut self, name: &str, reader: &mut dyn Read) -> Result<(), Stop> {
        let is_full = self.explanations.len() >= 5 * limits::EXPLANATIONS;
        if is_full && self.kind(name) == Kind::Explanation {
            self.note(Note::PassedOver(format!("{name}: too many explanations")));
            return Ok(());
        }
        // It may still be a source.
        let max = if is_full { limits::SOURCE } else { limits::ATTACHMENT };
        let passed_over = match self.budget().read(reader, max)? {
            Ok(Some(bytes)) => {
                let small = bytes.len() as u64 <= limits::SOURCE;
                if self.kind(name) == Kind::Text && small && self.is_source(&bytes) {
                    return self.keep_other(name, bytes);
                }
                // Those of the project are dropped at the end.
                if !is_full {
                    self.explanations.push(explanation(name, &bytes));
                    return Ok(());
                }
                format!("{name}: too many explanations")
            }
            Ok(None) => format!("{name} is too large for an explanation"),
            Err(error) => format!("{name}: {error}"),
        };
        self.note(Note::PassedOver(passed_over));
        Ok(())
    }

    fn offer_source(&mut self, name: &str, reader: &mut dyn Read, depth: usize) -> Result<(), Stop> {
        let is_named = self.kind(name) == Kind::Named;
        let max = limits::SOURCE;
        match self.budget().read(reader, max)? {
            Ok(Some(bytes)) if is_named => return self.offer_as_source(name, bytes),
            Ok(Some(bytes)) => return self.keep_other(name, bytes),
            Ok(None) if is_named => {
                self.bad_source(Refusal::TooLarge { name: name.to_owned(), max });
            }
            // Inside an archive it is the archive that is broken, and not the machine.
            Err(error) if is_named && depth > 0 => {
                self.bad_source(Refusal::BrokenArchive(name.to_owned(), error.to_string()));
            }
            Err(error) if is_named => {
                self.bad_source(Refusal::Unreadable(name.to_owned(), error.to_string()));
            }
            Ok(None) | Err(_) => {}
        }
        Ok(())
    }

    /// Takes a file as the source, whatever its name.
    pub(super) fn offer_as_source(&mut self, name: &str, bytes: Vec<u8>) -> Result<(), Stop> {
        self.budget.keep(bytes.len() as u64)?;
        self.candidates.named.push(Found::new(name, bytes));
        Ok(())
    }

    fn keep_other(&mut self, name: &str, bytes: Vec<u8>) -> Result<(), Stop> {
        self.budget.keep(bytes.len() as u64)?;
        self.candidates.other.push(Found::new(name, bytes));
        Ok(())
    }

    /// Selects the source to grade: the one at `picked`, if that is given.
    pub(super) fn conclude(mut self, path: PathBuf, picked: Option<&str>) -> Intake {
        let chosen = match self.budget.exceeded() {
            Some(refusal) => Err(refusal),
            None => self.candidates.choose(&self.wanted, picked, &mut self.notes),
        };
        let outcome = match chosen {
            Ok(chosen) => {
                let passed_over = self.candidates.bad.iter().chain(&self.obstacles);
                self.notes.extend(passed_over.map(|obstacle| Note::PassedOver(obstacle.to_string())));
                self.checksums.extend(chosen.checksums);
                Ok(Submission { path, source: chosen.text })
            }
            Err(Refusal::MissingFile(file, _)) => Err(self
                .obstacles
                .into_iter()
                .next()
                .unwrap_or_else(|| Refusal::MissingFile(file, std::mem::take(&mut self.seen)))),
            Err(refusal) => Err(refusal),
        };
        // With nothing else to mark, a README may be the explanation.
        if self.explanations.iter().any(|explanation| !is_ordinary(explanation)) {
            self.explanations.retain(|explanation| !is_ordinary(explanation));
        }
        self.explanations.truncate(limits::EXPLANATIONS);
        self.notes.truncate(limits::NOTES);
        Intake { outcome, notes: self.notes, explanations: self.explanations, checksums: self.checksums }
    }
}
