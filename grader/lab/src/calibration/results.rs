//! What was counted, kept so that nothing is computed twice.

use std::collections::BTreeSet;
use std::io::Write;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::Test;
use judge::statistics::sequential::Decision;
use verdict::error::{Error, Result};

/// How judgements ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counts {
    /// All of them.
    pub grades: u64,
    /// Those that found a bias.
    pub biased: u64,
    /// Those that could not tell.
    pub unclear: u64,
    /// Paths that they took.
    pub samples: u64,
}

impl Counts {
    /// One judgement.
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

/// One check of one variant with one bias: a line of the file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Line {
    /// Hash of all that the result depends on.
    pub key: String,
    /// The variant's name.
    pub variant: String,
    /// The check.
    pub check: String,
    /// Which test judged.
    #[serde(default)]
    pub test: Test,
    /// How much too bright all samples were made.
    pub bias: f64,
    /// What came out.
    pub counts: Counts,
    /// Processor time of a path, in seconds.
    #[serde(default)]
    pub seconds_per_path: f64,
}

impl Line {
    /// Paths of one judgement.
    pub(super) fn paths(&self) -> f64 {
        self.counts.samples as f64 / self.counts.grades.max(1) as f64
    }

    /// Processor time of one judgement, in seconds.
    pub(super) fn seconds(&self) -> f64 {
        self.paths() * self.seconds_per_path
    }

    /// True if what was to be found was found in 19 of 20 draws.
    pub(super) fn found(&self) -> bool {
        self.counts.grades > 0 && 20 * self.counts.biased >= 19 * self.counts.grades
    }
}

/// A file of results, a JSON object a line.
pub struct Results {
    path: PathBuf,
    lines: Vec<Line>,
}

impl Results {
    /// Opens the file in a folder, which is made if it is not there.
    ///
    /// # Errors
    /// If it is there and cannot be read.
    pub fn open(folder: &Path) -> Result<Self> {
        std::fs::create_dir_all(folder).map_err(|error| Error::file(folder, error))?;
        let path = folder.join("resampled.jsonl");
        let text = match std::fs::read_to_string(&path) {
            Ok(text) => text,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => String::new(),
            Err(error) => return Err(Error::file(&path, error)),
        };
        // A line that was cut off, or is of an older format, is a result to be computed again.
        let mut results = Self { path, lines: Vec::new() };
        text.lines().filter_map(|line| serde_json::from_str(line).ok()).for_each(|line| results.keep(line));
        Ok(results)
    }

    /// A result takes the place of an earlier one of the same, which was of fewer draws.
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

    /// The result that is there already.
    pub fn find(&self, key: &str, variant: &str, check: &str, test: Test, bias: f64) -> Option<&Line> {
        let wanted = (key, variant, check, test, bias);
        self.lines.iter().find(|line| {
            (line.key.as_str(), line.variant.as_str(), line.check.as_str(), line.test, line.bias) == wanted
        })
    }

    /// All results of some keys.
    pub fn of<'a>(&'a self, keys: &'a BTreeSet<String>) -> impl Iterator<Item = &'a Line> {
        self.lines.iter().filter(|line| keys.contains(&line.key))
    }

    /// Adds a result, on the disk too.
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
            .map_err(|error| Error::file(&self.path, error))?;
        self.keep(line);
        Ok(())
    }
}
