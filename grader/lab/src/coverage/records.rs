//! Comparisons on disk, one JSON object per line.

use std::io::Write;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::planted::Planted;
use crate::output::{create_folder, failed};
use verdict::convergence::Panel;
use verdict::error::{Error, Result};

/// One comparison.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Hash of the framework and of the code that measures.
    pub key: String,
    /// The difference between the programs; `None` if both are the solution.
    pub planted: Option<Planted>,
    /// Name of the scene.
    pub scene: String,
    /// Number of busy threads beside it.
    pub load: usize,
    /// Processor time in seconds.
    pub seconds: f64,
    /// Seed of all random numbers.
    pub seed: u64,
    /// The result; `None` before it is measured.
    pub panel: Option<Panel>,
}

/// The code that measures: results of another version do not count.
const MEASUREMENT: [&str; 5] = [
    include_str!("../../../judge/src/convergence/curve_run.rs"),
    include_str!("../../../judge/src/convergence/jackknife.rs"),
    include_str!("../../../judge/src/convergence/measure.rs"),
    include_str!("../../../judge/src/convergence/plan.rs"),
    include_str!("../../../judge/src/convergence/tally.rs"),
];

impl Record {
    pub(super) fn new(
        framework: &str,
        planted: Option<Planted>,
        scene: &str,
        (load, seconds): (usize, f64),
        seed: u64,
    ) -> Self {
        let mut hasher = blake3::Hasher::new();
        hasher.update(framework.as_bytes());
        MEASUREMENT.iter().for_each(|text| {
            hasher.update(text.as_bytes());
        });
        let key = hasher.finalize().to_hex().to_string();
        Self { key, planted, scene: scene.to_owned(), load, seconds, seed, panel: None }
    }

    fn is_same(&self, other: &Self) -> bool {
        let identity = |record: &Self| (record.planted, record.load, record.seconds.to_bits(), record.seed);
        (&self.key, &self.scene) == (&other.key, &other.scene) && identity(self) == identity(other)
    }
}

/// A file of comparisons.
pub struct Records {
    path: PathBuf,
    /// All comparisons of the current version.
    pub list: Vec<Record>,
}

impl Records {
    /// Opens the file in a folder, which is created if it is missing.
    ///
    /// # Errors
    /// If the folder cannot be created or the file cannot be read.
    pub fn open(folder: &Path) -> Result<Self> {
        create_folder(folder)?;
        let path = folder.join("comparisons.jsonl");
        let text = match std::fs::read_to_string(&path) {
            Ok(text) => text,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => String::new(),
            Err(error) => return Err(Error::file(&path, error)),
        };
        // A line that was cut off does not parse: that comparison is made again.
        let list = text.lines().filter_map(|line| serde_json::from_str(line).ok()).collect();
        Ok(Self { path, list })
    }

    /// True if the comparison has been made.
    pub(super) fn has(&self, record: &Record) -> bool {
        self.list.iter().any(|other| other.is_same(record))
    }

    /// Adds a comparison to the file.
    pub(super) fn add(&mut self, record: Record) -> Result<()> {
        let text = serde_json::to_string(&record).map_err(|error| Error::Harness(error.to_string()))?;
        std::fs::OpenOptions::new()
            .create(true)
            .append(true)
            .open(&self.path)
            .and_then(|mut file| writeln!(file, "{text}"))
            .map_err(|error| failed(&self.path, error))?;
        self.list.push(record);
        Ok(())
    }

    /// The comparisons of the version that made the last one.
    pub fn current(&self) -> Vec<&Record> {
        let key = self.list.last().map(|record| &record.key);
        self.list.iter().filter(|record| Some(&record.key) == key).collect()
    }
}
