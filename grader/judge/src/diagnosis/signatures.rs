//! Signatures: the observation vectors of graded variants, and their file.
//!
//! The file lists the identities of all checks once. For each variant and seed, it has a string with one letter per
//! check (`.` pass, `?` inconclusive, `F` fail, `N` samples that are not radiance, `T` timeout, `C` crash, `-` not
//! run) and the numbers of the checks that did not pass.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::observation::{CheckObservations, CheckState, Number, ObservationVector};
use crate::checks::Quantity;
use verdict::check::CheckId;
use verdict::error::{Error, Result};

/// The observation vectors of graded variants.
#[derive(Clone, Debug, Default)]
pub struct Signatures {
    vectors: BTreeMap<(String, u64), ObservationVector>,
}

/// Letter of a check that was not run.
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
    /// Numbers of the checks that did not pass, by index of the check.
    numbers: BTreeMap<usize, Vec<(Quantity, Number)>>,
}

impl Signatures {
    /// Adds the vector of a variant graded with a seed.
    pub fn insert(&mut self, variant: &str, seed: u64, vector: ObservationVector) {
        self.vectors.insert((variant.to_owned(), seed), vector);
    }

    /// The signature of a variant: its vector with the smallest seed. `None` if the variant has not been graded.
    pub fn get(&self, variant: &str) -> Option<&ObservationVector> {
        let mut of_variant = self.vectors.range((variant.to_owned(), 0)..=(variant.to_owned(), u64::MAX));
        of_variant.next().map(|(_, vector)| vector)
    }

    /// All vectors, with variant and seed.
    pub fn all(&self) -> impl Iterator<Item = (&str, u64, &ObservationVector)> {
        self.vectors.iter().map(|((variant, seed), vector)| (variant.as_str(), *seed, vector))
    }

    /// True if there are no vectors.
    pub fn is_empty(&self) -> bool {
        self.vectors.is_empty()
    }

    /// Reads a file written by [`Self::save`].
    ///
    /// # Errors
    /// If it cannot be read or is malformed.
    pub fn load(path: &Path) -> Result<Self> {
        let blame = |message: String| Error::file(path, message);
        let text = std::fs::read_to_string(path).map_err(|error| Error::file(path, error))?;
        let file: SignatureFile = serde_json::from_str(&text).map_err(|error| blame(error.to_string()))?;
        let mut signatures = Self::default();
        for mut row in file.variants {
            if row.states.chars().count() != file.checks.len() {
                return Err(blame(format!("{}: `states` must have one letter per check", row.variant)));
            }
            let mut vector = ObservationVector::default();
            for (index, (check, letter)) in file.checks.iter().zip(row.states.chars()).enumerate() {
                if letter == NOT_RUN {
                    continue;
                }
                let known = CheckState::LETTERS.iter().find(|(_, other)| *other == letter);
                let Some(&(state, _)) = known else {
                    return Err(blame(format!("{}: unknown letter `{letter}` in `states`", row.variant)));
                };
                let numbers = row.numbers.remove(&index).unwrap_or_default().into_iter().collect();
                vector.0.insert(check.clone(), CheckObservations { state, numbers });
            }
            signatures.insert(&row.variant, row.seed, vector);
        }
        Ok(signatures)
    }

    /// Writes the vectors, one line per variant and seed. `made_by` is the command that made them.
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

/// Rounds to the digits that are significant.
fn rounded(Number(value, error): Number) -> Number {
    let round = |value: f64| (value * 1e4).round() / 1e4;
    Number(round(value), round(error))
}
