//! What failed facts of the audit say about the cause.

use std::collections::BTreeSet;
use std::path::Path;

use serde::{Deserialize, Serialize};
use verdict::audit::Audit;
use verdict::error::{Error, Result};

use super::{Catalogue, Cause};

/// The failed facts of all variants, as `cargo lab facts` measures them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LearntFacts {
    /// One row per variant.
    pub rows: Vec<FactRow>,
}

/// The failed facts of one variant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FactRow {
    /// Name of the variant.
    pub variant: String,
    /// The failed facts, in the order in which they are read.
    pub failed: Vec<FailedFact>,
    /// True if the variant ended before all facts were measured.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub ended_early: bool,
}

/// Name of a failed fact, and its measured value; `None` if there is none, or it is NaN or infinite.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FailedFact(pub String, pub Option<f64>);

impl FailedFact {
    /// All failed facts of an audit.
    pub fn all(audit: &Audit) -> Vec<Self> {
        let rounded = |value: f64| (value * 1e4).round() / 1e4;
        audit.failed().map(|fact| Self(fact.id(), fact.measured.map(rounded))).collect()
    }

    /// True if both are the same fact with the same value, but for rounding and noise.
    fn resembles(&self, other: &Self) -> bool {
        let is_same = match (self.1, other.1) {
            (Some(a), Some(b)) => (a - b).abs() <= SAME_VALUE * (1.0 + a.abs().max(b.abs())),
            (a, b) => a.is_none() && b.is_none(),
        };
        self.0 == other.0 && is_same
    }
}

/// Difference of two measured values, relative to 1 + the larger one, up to which they count as equal. Exponents of
/// different mistakes differ by 1/2 or more; what is measured with random numbers varies by less than this.
const SAME_VALUE: f64 = 0.05;

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct FactsFile {
    made_by: String,
    variants: Vec<FactRow>,
}

impl LearntFacts {
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

    /// The only cause whose variants have exactly these failed facts, with these values; `None` if there is none, or
    /// several.
    pub fn exact<'a>(&self, catalogue: &'a Catalogue, failed: &[FailedFact]) -> Option<&'a Cause> {
        if failed.is_empty() {
            return None;
        }
        let same = self.rows.iter().filter(|row| {
            row.failed.len() == failed.len() && row.failed.iter().zip(failed).all(|(a, b)| a.resembles(b))
        });
        let causes: BTreeSet<&str> =
            same.filter_map(|row| catalogue.cause_of(&row.variant)).map(|cause| cause.id.as_str()).collect();
        let [id] = Vec::from_iter(causes)[..] else { return None };
        catalogue.causes().iter().find(|cause| cause.id == id)
    }
}
