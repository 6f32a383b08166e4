//! Why is it wrong? Likely causes of what the checks of a report have found, in words for students.
//!
//! A report is turned into [`ObservationVector`], what each check saw as numbers (`observation`). The wrong variants
//! of the solution have been graded, and their vectors are the *signatures* of the mistakes that are known
//! (`signatures`, `cargo lab signatures`). The causes of a report are those whose signatures are nearest (`distance`,
//! `rank`), unless even the nearest is too far: then the cause is unknown, and the report says so. What can be seen
//! without any comparison is told first (`direct`): a file that does not compile or panics, tasks that nobody has
//! begun. The words stand in the assignment's `causes.yml`, and `seen` names the checks that decided.
//!
//! Whatever is compared, only checks count that both sides have: a grade may leave checks out, or stop early.

mod confusion;
mod direct;
mod distance;
mod observation;
mod rank;
mod seen;
mod signatures;

pub use confusion::{Case, Confusion};
pub use observation::{CheckObservations, CheckState, Number, ObservationVector};
pub use signatures::Signatures;

use std::path::{Path, PathBuf};

use arty::integrator::Technique;
use serde::Deserialize;

use verdict::check::CheckResult;
use verdict::error::{Error, Result};
use verdict::report::{self, Diagnosis, Report};

/// How many causes are named at most.
pub const MAX_CAUSES: usize = 3;

/// Name of the cause that is not known.
pub const UNKNOWN: &str = "unknown";

/// The mistakes that are known in an assignment.
#[derive(Clone, Debug, Default)]
pub struct Catalogue {
    causes: Vec<Cause>,
    signatures: Signatures,
}

/// A mistake in words.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cause {
    /// Its name.
    pub id: String,
    /// The wrong variants that show how it looks.
    pub variants: Vec<String>,
    /// What it is, in a sentence.
    pub title: String,
    /// What to think about.
    pub hint: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct CausesFile {
    causes: Vec<Cause>,
}

impl Catalogue {
    /// Reads an assignment's causes and signatures. An assignment need not have them: then only what is seen directly
    /// is diagnosed.
    ///
    /// # Errors
    /// If one of the files is not as it should be, or signatures are missing for a variant that a cause names.
    pub fn load(assignment: &Path) -> Result<Self> {
        let (words, measured) = (Self::words_file(assignment), Self::signatures_file(assignment));
        let catalogue = Self {
            causes: if words.is_file() {
                arty::yaml::read::<CausesFile>(&words)?.0.causes
            } else {
                Vec::new()
            },
            signatures: if measured.is_file() { Signatures::load(&measured)? } else { Signatures::default() },
        };
        for cause in &catalogue.causes {
            for variant in &cause.variants {
                if !catalogue.signatures.is_empty() && catalogue.signatures.get(variant).is_none() {
                    let message = format!(
                        "{}: nothing was measured of the variant {variant}; run `cargo lab signatures`",
                        cause.id
                    );
                    return Err(Error::file(&words, message));
                }
            }
        }
        Ok(catalogue)
    }

    /// The file with the words.
    pub fn words_file(assignment: &Path) -> PathBuf {
        assignment.join("causes.yml")
    }

    /// The file with what was measured.
    pub fn signatures_file(assignment: &Path) -> PathBuf {
        assignment.join("signatures.json")
    }

    /// The same words with other signatures.
    pub fn with(&self, signatures: Signatures) -> Self {
        Self { causes: self.causes.clone(), signatures }
    }

    /// All mistakes, in the order of the file.
    pub fn causes(&self) -> &[Cause] {
        &self.causes
    }

    /// The cause that a variant shows.
    pub fn cause_of(&self, variant: &str) -> Option<&Cause> {
        self.causes.iter().find(|cause| cause.variants.iter().any(|other| other == variant))
    }

    /// At most [`MAX_CAUSES`] likely causes, the likeliest first. None for a submission whose checks all pass.
    /// `starter` is the text of the assignment's starting file, empty if it has none.
    pub fn diagnose(&self, report: &Report, source: &str, starter: &str) -> Vec<Diagnosis> {
        let wrong = report.checks.iter().any(CheckResult::costs_points);
        if !wrong && report.submission.build_failure.is_none() {
            return Vec::new();
        }
        let mut found = direct::causes(report, source, starter);
        let explained = |technique: Technique| found.iter().any(|direct| direct.explains(technique));
        let vector = ObservationVector::of(report).without(explained);
        if found.iter().all(|direct| !direct.is_everything()) {
            found.extend(self.compared(report, &vector));
        }
        if found.is_empty() {
            found.extend(direct::constant_factor(report));
        }
        if found.is_empty() {
            let several_fit = rank::something_fits(self, &vector);
            return vec![Diagnosis {
                cause: report::Cause::Unknown { several_fit },
                confidence: 0.0,
                seen: None,
            }];
        }
        found.truncate(MAX_CAUSES);
        found.into_iter().map(|found| found.diagnosis).collect()
    }

    fn compared(&self, report: &Report, vector: &ObservationVector) -> Vec<ExplainedCause> {
        let found = |candidate: &rank::Candidate<'_>| {
            let Cause { id, title, hint, .. } = candidate.cause.clone();
            let seen = seen::seen(self, report, vector, candidate);
            let cause = report::Cause::Known { id, title, hint };
            ExplainedCause {
                diagnosis: Diagnosis { cause, confidence: candidate.confidence, seen },
                explains: Vec::new(),
            }
        };
        rank::rank(self, vector).iter().map(found).collect()
    }

    /// The names of the causes that a vector of observations is diagnosed with, as [`Self::diagnose`] would.
    pub fn names(&self, vector: &ObservationVector) -> Vec<&str> {
        if vector.all_pass() {
            return Vec::new();
        }
        let names: Vec<&str> = rank::rank(self, vector)
            .iter()
            .map(|candidate| candidate.cause.id.as_str())
            .take(MAX_CAUSES)
            .collect();
        if names.is_empty() { vec![UNKNOWN] } else { names }
    }
}

/// A cause, and what of the submission needs no other.
struct ExplainedCause {
    diagnosis: Diagnosis,
    /// The techniques whose failures it explains.
    explains: Vec<Technique>,
}

impl ExplainedCause {
    fn explains(&self, technique: Technique) -> bool {
        self.explains.contains(&technique)
    }

    /// True if nothing is left to be explained.
    fn is_everything(&self) -> bool {
        [Technique::Nee, Technique::Mis].into_iter().all(|technique| self.explains(technique))
    }
}
