//! What failed facts of the audit say about the cause.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use verdict::audit::{Audit, Fact};
use verdict::error::{Error, Result};

use super::{Catalogue, Cause};

/// The failed facts of all variants, as `cargo lab facts` measures them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LearntFacts {
    /// One row per variant.
    pub rows: Vec<FactRow>,
}

/// The failed facts of one variant.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FactRow {
    /// Name of the variant.
    pub variant: String,
    /// Names of the failed facts, in the order in which they are read.
    pub failed: Vec<String>,
    /// True if the variant ended before all facts were measured.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub ended_early: bool,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct FactsFile {
    made_by: String,
    variants: Vec<FactRow>,
}

impl LearntFacts {
    /// Path of the file of an assignment.
    pub fn file(assignment: &Path) -> PathBuf {
        assignment.join("facts.json")
    }

    /// Reads a file written by [`Self::save`].
    ///
    /// # Errors
    /// If it cannot be read or is malformed.
    pub fn load(path: &Path) -> Result<Self> {
        let text = std::fs::read_to_string(path).map_err(|error| Error::file(path, error))?;
        let file: FactsFile = serde_json::from_str(&text).map_err(|error| Error::file(path, error))?;
        Ok(Self { rows: file.variants })
    }

    /// Writes the table, one line per variant. `made_by` is the command that made it.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn save(&self, path: &Path, made_by: &str) -> Result<()> {
        let json =
            |value: &FactRow| serde_json::to_string(value).map_err(|error| Error::Harness(error.to_string()));
        let lines = self.rows.iter().map(json).collect::<Result<Vec<String>>>()?;
        let text = format!("{{\"made_by\":\"{made_by}\",\n\"variants\":[\n{}\n]}}\n", lines.join(",\n"));
        verdict::output::write_bytes(path, text)
    }

    /// The row of a variant.
    pub fn row(&self, variant: &str) -> Option<&FactRow> {
        self.rows.iter().find(|row| row.variant == variant)
    }

    /// The table without some variants.
    #[must_use]
    pub fn without(&self, variants: &[String]) -> Self {
        Self { rows: self.rows.iter().filter(|row| !variants.contains(&row.variant)).cloned().collect() }
    }

    /// The only cause whose variants have exactly these failed facts; `None` if there is none, or several.
    pub fn exact<'a>(&self, catalogue: &'a Catalogue, failed: &[String]) -> Option<&'a Cause> {
        let failed: BTreeSet<&String> = failed.iter().collect();
        if failed.is_empty() {
            return None;
        }
        let same = self.rows.iter().filter(|row| row.failed.iter().collect::<BTreeSet<_>>() == failed);
        let causes: BTreeSet<&str> =
            same.filter_map(|row| catalogue.cause_of(&row.variant)).map(|cause| cause.id.as_str()).collect();
        let [id] = Vec::from_iter(causes)[..] else { return None };
        catalogue.causes().iter().find(|cause| cause.id == id)
    }
}

/// The failed facts that are worth a statement: the first of each term, without those that follow from an earlier one.
pub(super) fn statements(audit: &Audit) -> Vec<&Fact> {
    let mut stated: Vec<&Fact> = Vec::new();
    for fact in audit.failed() {
        if stated.iter().all(|other| other.term != fact.term) {
            stated.push(fact);
        }
    }
    stated
}
