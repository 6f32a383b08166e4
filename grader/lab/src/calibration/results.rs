//! Counted decisions, kept on disk so that no simulation runs twice.

use std::collections::BTreeSet;
use std::io::Write;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::Test;
use crate::output::{create_folder, failed};
use judge::statistics::sequential::Decision;
use verdict::check::CheckId;
use verdict::error::{Error, Result};

/// Decisions of simulated checks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counts {
    /// Simulated checks.
    pub grades: u64,
    /// Of these, biased.
    pub biased: u64,
    /// Of these, inconclusive.
    pub unclear: u64,
    /// Paths traced in all of them.
    pub samples: u64,
}

impl Counts {
    /// A single decision.
    pub(super) fn of(decision: Decision, samples: u64) -> Self {
        let is = |other| u64::from(decision == other);
        Self { grades: 1, biased: is(Decision::Biased), unclear: is(Decision::Unclear), samples }
    }
}

impl std::ops::Add for Counts {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            grades: self.grades + other.grades,
            biased: self.biased + other.biased,
            unclear: self.unclear + other.unclear,
            samples: self.samples + other.samples,
        }
    }
}

/// One check of one variant at one bias: a line of the file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Line {
    /// Hash of everything that the result depends on.
    pub key: String,
    /// Name of the variant.
    pub variant: String,
    /// The check.
    pub check: CheckId,
    /// The test.
    #[serde(default)]
    pub test: Test,
    /// Relative error that was added to all samples.
    pub bias: f64,
    /// The decisions.
    pub counts: Counts,
    /// Processor time of a path in seconds.
    #[serde(default)]
    pub seconds_per_path: f64,
}

impl Line {
    /// Paths per decision.
    pub(super) fn paths(&self) -> f64 {
        self.counts.samples as f64 / self.counts.grades.max(1) as f64
    }

    /// Processor time per decision in seconds.
    pub(super) fn seconds(&self) -> f64 {
        self.paths() * self.seconds_per_path
    }

    /// True if the error was found in at least 19 of 20 draws.
    pub(super) fn found(&self) -> bool {
        self.counts.grades > 0 && 20 * self.counts.biased >= 19 * self.counts.grades
    }
}

/// A file of results, one JSON object per line.
pub struct Results {
    path: PathBuf,
    lines: Vec<Line>,
}

impl Results {
    /// Opens the file in a folder, which is created if it is missing.
    ///
    /// # Errors
    /// If the folder cannot be created or the file cannot be read.
    pub fn open(folder: &Path) -> Result<Self> {
        create_folder(folder)?;
        let path = folder.join("resampled.jsonl");
        let text = match std::fs::read_to_string(&path) {
            Ok(text) => text,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => String::new(),
            Err(error) => return Err(Error::file(&path, error)),
        };
        // A line that was cut off or is of an older format does not parse: its result is computed again.
        let mut results = Self { path, lines: Vec::new() };
        text.lines().filter_map(|line| serde_json::from_str(line).ok()).for_each(|line| results.keep(line));
        Ok(results)
    }

    /// Adds a result, or replaces the earlier one of the same experiment, which had fewer draws.
    fn keep(&mut self, line: Line) {
        let is_same = |other: &&mut Line| {
            (&other.key, &other.variant, &other.check, other.test, other.bias)
                == (&line.key, &line.variant, &line.check, line.test, line.bias)
        };
        match self.lines.iter_mut().find(is_same) {
            Some(earlier) => *earlier = line,
            None => self.lines.push(line),
        }
    }

    /// The result that is known already.
    pub fn find(&self, key: &str, variant: &str, check: &CheckId, test: Test, bias: f64) -> Option<&Line> {
        let wanted = (key, variant, check, test, bias);
        self.lines.iter().find(|line| {
            (line.key.as_str(), line.variant.as_str(), &line.check, line.test, line.bias) == wanted
        })
    }

    /// All results with one of these keys.
    pub fn of<'a>(&'a self, keys: &'a BTreeSet<String>) -> impl Iterator<Item = &'a Line> {
        self.lines.iter().filter(|line| keys.contains(&line.key))
    }

    /// Adds a result to the file.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn add(&mut self, line: Line) -> Result<()> {
        let text = serde_json::to_string(&line).map_err(|error| Error::Harness(error.to_string()))?;
        std::fs::OpenOptions::new()
            .create(true)
            .append(true)
            .open(&self.path)
            .and_then(|mut file| writeln!(file, "{text}"))
            .map_err(|error| failed(&self.path, error))?;
        self.keep(line);
        Ok(())
    }
}
