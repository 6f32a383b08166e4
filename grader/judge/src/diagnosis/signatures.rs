//! What was measured of variants, and the file that holds it.
//!
//! The file has the names of all checks once, and for each variant and seed a string with one letter a check
//! (`.` pass, `?` unclear, `F` wrong, `N` samples that are no radiance, `T` out of time, `C` crashed, `-` not run) and
//! the numbers of those that did not pass.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::observation::{CheckObservations, CheckState, Number, ObservationVector};
use crate::checks::Quantity;
use verdict::check::CheckId;
use verdict::error::{Error, Result};

/// The vectors of variants.
#[derive(Clone, Debug, Default)]
pub struct Signatures {
    vectors: BTreeMap<(String, u64), ObservationVector>,
}

/// A check that was not run.
const NOT_RUN: char = '-';

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SignatureFile {
    made_by: String,
    checks: Vec<CheckId>,
    variants: Vec<SignatureRow>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SignatureRow {
    variant: String,
    seed: u64,
    states: String,
    /// By the check's place in the list.
    numbers: BTreeMap<usize, Vec<(Quantity, Number)>>,
}

impl Signatures {
    /// Adds what was measured of a variant with a seed.
    pub fn insert(&mut self, variant: &str, seed: u64, vector: ObservationVector) {
        self.vectors.insert((variant.to_owned(), seed), vector);
    }

    /// What was measured of a variant, with the first of its seeds.
    pub fn get(&self, variant: &str) -> Option<&ObservationVector> {
        let mut of_variant = self.vectors.range((variant.to_owned(), 0)..=(variant.to_owned(), u64::MAX));
        of_variant.next().map(|(_, vector)| vector)
    }

    /// All that was measured: variant, seed, vector.
    pub fn all(&self) -> impl Iterator<Item = (&str, u64, &ObservationVector)> {
        self.vectors.iter().map(|((variant, seed), vector)| (variant.as_str(), *seed, vector))
    }

    /// True if nothing was measured.
    pub fn is_empty(&self) -> bool {
        self.vectors.is_empty()
    }

    /// Reads what [`Self::save`] has written.
    ///
    /// # Errors
    /// If it cannot be read, or is not that.
    pub fn load(path: &Path) -> Result<Self> {
        let blame = |message: String| Error::file(path, message);
        let text = std::fs::read_to_string(path).map_err(|error| Error::file(path, error))?;
        let file: SignatureFile = serde_json::from_str(&text).map_err(|error| blame(error.to_string()))?;
        let mut signatures = Self::default();
        for mut row in file.variants {
            if row.states.chars().count() != file.checks.len() {
                return Err(blame(format!("{}: not one letter for each check", row.variant)));
            }
            let mut vector = ObservationVector::default();
            for (index, (check, letter)) in file.checks.iter().zip(row.states.chars()).enumerate() {
                if letter == NOT_RUN {
                    continue;
                }
                let known = CheckState::LETTERS.iter().find(|(_, other)| *other == letter);
                let Some(&(state, _)) = known else {
                    return Err(blame(format!("{}: the letter `{letter}` means nothing", row.variant)));
                };
                let numbers = row.numbers.remove(&index).unwrap_or_default().into_iter().collect();
                vector.0.insert(check.clone(), CheckObservations { state, numbers });
            }
            signatures.insert(&row.variant, row.seed, vector);
        }
        Ok(signatures)
    }

    /// Writes them, a line for each variant and seed.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn save(&self, path: &Path, made_by: &str) -> Result<()> {
        let mut checks: Vec<CheckId> =
            self.vectors.values().flat_map(|vector| vector.0.keys().cloned()).collect();
        checks.sort();
        checks.dedup();
        let rows = self.vectors.iter().map(|((variant, seed), vector)| row(variant, *seed, vector, &checks));
        let lines = rows.map(|row| json(&row)).collect::<Result<Vec<String>>>()?;
        let (made_by, checks) = (json(&made_by)?, json(&checks)?);
        let text = format!(
            "{{\"made_by\":{made_by},\n\"checks\":{checks},\n\"variants\":[\n{}\n]}}\n",
            lines.join(",\n")
        );
        verdict::output::write_bytes(path, text)
    }
}

fn json(value: &impl Serialize) -> Result<String> {
    serde_json::to_string(value).map_err(|error| Error::Harness(error.to_string()))
}

fn row(variant: &str, seed: u64, vector: &ObservationVector, checks: &[CheckId]) -> SignatureRow {
    let letter = |check: &CheckId| {
        let state = vector.0.get(check).map(|seen| seen.state);
        CheckState::LETTERS
            .iter()
            .find(|(other, _)| Some(*other) == state)
            .map_or(NOT_RUN, |&(_, letter)| letter)
    };
    let numbers = |(index, check): (usize, &CheckId)| {
        let numbers = &vector.0.get(check)?.numbers;
        (!numbers.is_empty())
            .then(|| (index, numbers.iter().map(|(quantity, it)| (quantity.clone(), rounded(*it))).collect()))
    };
    SignatureRow {
        variant: variant.to_owned(),
        seed,
        states: checks.iter().map(letter).collect(),
        numbers: checks.iter().enumerate().filter_map(numbers).collect(),
    }
}

/// More digits than these mean nothing.
fn rounded(Number(value, error): Number) -> Number {
    let round = |value: f64| (value * 1e4).round() / 1e4;
    Number(round(value), round(error))
}
