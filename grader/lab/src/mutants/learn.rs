//! Signatures of known mistakes, and how often they name the right cause.

use super::{Kind, Ledger, Variant};
use judge::diagnosis::{Catalogue, Confusion, ObservationVector, Signatures};
use verdict::check::CheckId;
use verdict::error::{Error, Result};
use verdict::rubric::Rubric;

/// Failures per task after which a grade is cut off, to see how the diagnosis of early stops fares.
const EARLY_STOPS: [usize; 3] = [1, 2, 4];

/// Grades apart by what they are for: no grade is both learnt from and tested on.
#[derive(Default)]
pub struct Learnt {
    /// The wrong variants, graded with the seed to learn from.
    pub signatures: Signatures,
    /// All other grades, of the correct variants too.
    pub cases: Signatures,
}

/// Splits the grades of all variants as they are now.
///
/// # Errors
/// If a wrong variant was not graded with the seed to learn from, or a report cannot be read.
pub fn learn(ledger: &Ledger, variants: &[Variant], rubric: &Rubric, seed: u64) -> Result<Learnt> {
    let techniques = rubric.student_techniques();
    let mut learnt = Learnt::default();
    for variant in variants {
        for record in ledger.records(variant) {
            let vector = ObservationVector::of(&ledger.report(record)?, &techniques);
            if record.seed != seed || variant.kind == Kind::Right {
                learnt.cases.insert(&variant.id, record.seed, vector);
            } else {
                learnt.signatures.insert(&variant.id, record.seed, vector);
            }
        }
    }
    let is_missing =
        |variant: &&Variant| variant.kind == Kind::Wrong && learnt.signatures.get(&variant.id).is_none();
    let missing: Vec<&str> = variants.iter().filter(is_missing).map(|variant| variant.id.as_str()).collect();
    if !missing.is_empty() {
        return Err(Error::Input(format!(
            "not graded with seed {seed} in their present form: {}\nrun `cargo lab mutants --seeds=3` first",
            missing.join(", ")
        )));
    }
    Ok(learnt)
}

impl Learnt {
    /// Diagnoses all cases, completely and cut off after some failures per task.
    pub fn confusion(&self, catalogue: &Catalogue, rubric: &Rubric) -> (Confusion, Vec<(usize, Confusion)>) {
        let order: Vec<(String, CheckId)> =
            rubric.checks().map(|(task, spec)| (task.id.clone(), spec.id())).collect();
        let diagnosed = |change: &dyn Fn(&ObservationVector) -> ObservationVector| {
            let mut confusion = Confusion::default();
            for (variant, seed, vector) in self.cases.all() {
                confusion.add(catalogue, variant, seed, &change(vector));
            }
            confusion
        };
        let early = EARLY_STOPS
            .map(|failures| (failures, diagnosed(&|vector| vector.stopped_after(&order, failures))));
        (diagnosed(&ObservationVector::clone), early.into())
    }
}
