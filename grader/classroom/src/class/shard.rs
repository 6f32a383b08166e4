//! A class on several machines: each grades a shard of the students, and the results are merged.
//!
//! A student's shard depends on nothing but the student's key, or the team's name, so that a late submission moves nobody
//! and a team's submission is graded once. Each machine reads the whole class and grades its own part into a folder of
//! its own.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::gradebook::Row;
use super::identity::team_key;
use super::similar::Fingerprint;
use super::{Class, Outcome};
use crate::policy::Policy;
use verdict::error::{Error, Result};
use verdict::output;
use verdict::report::Provenance;
use verdict::sandbox::Level;

/// Version of the format of `shard.json`.
const SCHEMA: &str = "arty-shard/2";

/// A part of a class, written `index/count`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Shard {
    /// Number of this part, counted from 1.
    pub index: u32,
    /// Number of all parts.
    pub count: u32,
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> std::result::Result<Self, String> {
        let wrong = || format!("`{text}` is no shard: write 2/8 for the second of eight");
        let (index, count) = text.split_once('/').ok_or_else(wrong)?;
        let number = |text: &str| text.parse().map_err(|_| wrong());
        let shard = Self { index: number(index)?, count: number(count)? };
        if (1..=shard.count).contains(&shard.index) && shard.count <= 10_000 {
            Ok(shard)
        } else {
            Err(wrong())
        }
    }
}

impl std::fmt::Display for Shard {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(formatter, "shard {} of {}", self.index, self.count)
    }
}

impl Shard {
    /// True if the student with this key, or the team with this name, is in this shard.
    pub fn contains(self, key: &str) -> bool {
        let mut first = [0; 8];
        first.copy_from_slice(&blake3::hash(key.as_bytes()).as_bytes()[..8]);
        u64::from_le_bytes(first) % u64::from(self.count) == u64::from(self.index - 1)
    }

    /// Folder of its results in those of the class.
    pub fn folder(self, out: &Path) -> PathBuf {
        out.join(format!("{PREFIX}{}-of-{}", self.index, self.count))
    }
}

const PREFIX: &str = "shard-";

/// Folders of shards in the results of a class, sorted.
///
/// # Errors
/// If the folder cannot be read, or has none.
pub fn folders(out: &Path) -> Result<Vec<PathBuf>> {
    let entries = std::fs::read_dir(out).map_err(|error| Error::file(out, error))?;
    let paths = entries.flatten().map(|entry| entry.path());
    let is_shard = |path: &PathBuf| {
        path.is_dir() && path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(PREFIX))
    };
    let mut found: Vec<PathBuf> = paths.filter(is_shard).collect();
    found.sort();
    if found.is_empty() {
        return Err(Error::file(out, "there are no shards in this folder (see cargo grader class --shard)"));
    }
    Ok(found)
}

impl Class {
    /// Leaves the members of one shard.
    pub fn keep(&mut self, shard: Shard) {
        self.members.retain(|member| {
            let is_alone = member.team.is_empty();
            if is_alone { shard.contains(&member.key) } else { shard.contains(&team_key(&member.team)) }
        });
    }
}

/// The results of one shard, as stored when all of its members are graded.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct ShardFile {
    schema: String,
    /// Number of this shard, and how many there are.
    pub shard: Shard,
    /// Versions and seeds of all grades.
    pub provenance: Provenance,
    /// Hash of everything that verdicts depend on except the submissions.
    inputs: String,
    /// Hash of the roster.
    roster: String,
    /// Hash of deadlines, extensions and receipt times.
    dates: String,
    /// Keys of the whole class, in the order of its rows.
    pub members: Vec<String>,
    /// Rows of this shard.
    pub rows: Vec<Row>,
    /// Fingerprints of this shard, by row key.
    pub fingerprints: BTreeMap<String, Fingerprint>,
    /// Changes since the last run.
    pub changes: Vec<String>,
    /// Number of submissions that were graded.
    pub graded: usize,
    /// Number of submissions that had not changed.
    pub unchanged: usize,
    /// Weakest sandbox of all its submissions.
    pub weakest_sandbox: Option<Level>,
    /// True if the course wants a leaderboard.
    pub leaderboard: bool,
}

/// What of a class decides about points besides the submissions; to be computed before [`Class::keep`].
#[derive(Clone, Debug)]
pub struct ClassHash {
    roster: String,
    dates: String,
}

impl ClassHash {
    /// Computes it.
    pub fn of(class: &Class, policy: Option<&Policy>) -> Self {
        let (mut roster, mut dates) = (blake3::Hasher::new(), blake3::Hasher::new());
        dates.update(format!("{policy:?}").as_bytes());
        for member in &class.members {
            roster.update(format!("{} {:?} {}", member.key, member.student, member.team).as_bytes());
            dates.update(format!("{} {:?}", member.key, member.receipts).as_bytes());
        }
        let text = |hasher: blake3::Hasher| hasher.finalize().to_hex().to_string();
        Self { roster: text(roster), dates: text(dates) }
    }
}

impl ShardFile {
    /// The results of a shard.
    pub fn new(shard: Shard, hash: ClassHash, members: Vec<String>, outcome: Outcome) -> Self {
        Self {
            schema: SCHEMA.to_owned(),
            shard,
            provenance: outcome.provenance,
            inputs: outcome.inputs,
            roster: hash.roster,
            dates: hash.dates,
            members,
            rows: outcome.rows,
            fingerprints: outcome.fingerprints,
            changes: outcome.changes,
            graded: outcome.graded,
            unchanged: outcome.unchanged,
            weakest_sandbox: outcome.weakest_sandbox,
            leaderboard: outcome.leaderboard,
        }
    }

    /// Path in the folder of a shard.
    pub fn path(folder: &Path) -> PathBuf {
        folder.join("shard.json")
    }

    /// Saves it.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn save(&self, folder: &Path) -> Result<()> {
        output::write_json(&Self::path(folder), self)
    }

    /// Reads it.
    ///
    /// # Errors
    /// If it is not there, because the run has not ended, or not valid.
    pub fn load(folder: &Path) -> Result<Self> {
        let path = Self::path(folder);
        let bytes = match std::fs::read(&path) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
                let remedy =
                    "this shard has not been graded to its end: continue it with --shard and --resume";
                return Err(Error::file(folder, remedy));
            }
            Err(error) => return Err(Error::file(&path, error)),
        };
        let file: Self = serde_json::from_slice(&bytes).map_err(|error| Error::file(&path, error))?;
        if file.schema != SCHEMA {
            return Err(Error::file(&path, format!("this is {}, not {SCHEMA}", file.schema)));
        }
        Ok(file)
    }

    /// What decides about points and must be the same in all shards, with its name.
    pub(super) fn common(&self) -> [(&'static str, String); 9] {
        let Provenance { grader, framework, rubric, references, seed, toolchain, .. } = &self.provenance;
        [
            ("number of shards", self.shard.count.to_string()),
            ("version of the grader", grader.clone()),
            ("framework", framework.clone()),
            ("compiler", toolchain.clone()),
            ("rubric", rubric.clone()),
            ("references", references.clone()),
            ("seed", seed.map_or_else(|| "secret".to_owned(), |seed| seed.to_string())),
            ("roster", format!("{} {:?}", self.roster, self.members)),
            ("deadline, extensions or receipt times", self.dates.clone()),
        ]
    }

    /// Hash of everything that verdicts depend on, to be compared where [`Self::common`] is the same.
    pub(super) fn inputs(&self) -> &str {
        &self.inputs
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_are_a_partition_that_depends_on_nothing_but_the_key() {
        for count in [1, 2, 3, 8] {
            for student in 0..200 {
                let key = format!("student-{student}");
                let shards = (1..=count).map(|index| Shard { index, count });
                assert_eq!(shards.filter(|shard| shard.contains(&key)).count(), 1, "{key} of {count}");
            }
        }
        let shard: Shard = "1/2".parse().expect("it is a shard");
        let own = (0..200).filter(|student| shard.contains(&format!("student-{student}"))).count();
        assert!((70..130).contains(&own), "about a half: {own}");
        for wrong in ["0/2", "3/2", "1", "1/0", "a/b", "-1/2"] {
            assert!(wrong.parse::<Shard>().is_err(), "{wrong}");
        }
    }
}
