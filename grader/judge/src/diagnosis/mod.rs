//! Diagnosis: likely causes of the failed checks of a report, in words for students.
//!
//! A report is converted to an [`ObservationVector`], the measurements of each check as numbers (`observation`). The
//! wrong variants of the solution have been graded, and their vectors are the *signatures* of the known mistakes
//! (`signatures`, `cargo lab signatures`). The causes of a report are those with the nearest signatures (`distance`,
//! `rank`); if even the nearest is too far, the cause is unknown, and the report says so. Causes that need no
//! comparison come first (`direct`): a submission that does not compile or panics, or tasks that have not been begun.
//! The texts are in the assignment's `causes.yml`, and `seen` selects the checks that are evidence for a cause.
//!
//! Only checks that both sides have are compared: a grade may omit checks, or stop early.

mod confusion;
mod direct;
mod distance;
mod facts;
mod observation;
mod rank;
mod seen;
mod signatures;

pub use confusion::{Case, Confusion};
pub use facts::{FactRow, FailedFact, LearntFacts};
pub use observation::{CheckObservations, CheckState, Number, ObservationVector};
pub use signatures::Signatures;

use std::path::Path;

use arty::integrator::Technique;
use harness::assignment_folder::AssignmentFolder;
use schemars::JsonSchema;
use serde::Deserialize;

use verdict::check::CheckResult;
use verdict::error::Result;
use verdict::report::{self, Diagnosis, Report};
use verdict::rubric::Rubric;

use direct::Techniques;

/// Maximum number of causes of a report.
pub const MAX_CAUSES: usize = 3;

/// Identifier of an unknown cause.
pub const UNKNOWN: &str = "unknown";

/// The known mistakes of an assignment.
#[derive(Clone, Debug, Default)]
pub struct Catalogue {
    causes: Vec<Cause>,
    signatures: Signatures,
    /// Failed facts of the known mistakes.
    facts: LearntFacts,
    techniques: Techniques,
}

/// A known mistake.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cause {
    /// Identifier.
    pub id: String,
    /// Names of the wrong variants that have this mistake.
    pub variants: Vec<String>,
    /// Description in one sentence.
    pub title: String,
    /// Hint for the student.
    pub hint: String,
    /// Beginnings of the names of facts that are about the factor which is wrong, such as `light-sample/distance`. They
    /// only measure how good statements are.
    #[serde(default)]
    pub facts: Vec<String>,
}

/// The contents of `causes.yml`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CausesFile {
    /// Known mistakes.
    causes: Vec<Cause>,
}

impl CausesFile {
    /// Reads the file.
    ///
    /// # Errors
    /// The first thing in it that is not as expected, with the line.
    pub fn load(path: &Path) -> Result<Self> {
        Ok(arty::yaml::read::<Self>(path)?.0)
    }

    /// The schema of the file, as JSON.
    pub fn schema() -> serde_json::Value {
        schemars::schema_for!(Self).into()
    }
}

impl Catalogue {
    /// Reads the causes and signatures of an assignment. Both files are optional: without them, only direct causes are
    /// found. A cause whose variants have no signature yet is found by facts alone.
    ///
    /// # Errors
    /// If one of the files is invalid.
    pub fn load(assignment: &AssignmentFolder, rubric: &Rubric) -> Result<Self> {
        let (words, measured) = (assignment.causes_file(), assignment.signatures_file());
        let facts = assignment.facts_file();
        Ok(Self {
            causes: if words.is_file() { CausesFile::load(&words)?.causes } else { Vec::new() },
            signatures: if measured.is_file() { Signatures::load(&measured)? } else { Signatures::default() },
            facts: if facts.is_file() { LearntFacts::load(&facts)? } else { LearntFacts::default() },
            techniques: Techniques {
                graded: rubric.student_techniques(),
                not_begun: rubric.not_begun.clone(),
                begin: rubric.begin.clone(),
            },
        })
    }

    /// The same causes with other signatures.
    pub fn with(&self, signatures: Signatures) -> Self {
        Self { signatures, ..self.clone() }
    }

    /// All known mistakes, in the order of the file.
    pub fn causes(&self) -> &[Cause] {
        &self.causes
    }

    /// The mistake of a variant; `None` if no cause names the variant.
    pub fn cause_of(&self, variant: &str) -> Option<&Cause> {
        self.causes.iter().find(|cause| cause.variants.iter().any(|other| other == variant))
    }

    /// At most [`MAX_CAUSES`] likely causes, most likely first. Empty for a submission whose checks all pass.
    /// `starter` is the text of the assignment's starting file, empty if it has none.
    pub fn diagnose(&self, report: &Report, source: &str, starter: &str) -> Vec<Diagnosis> {
        let wrong = report.checks.iter().any(CheckResult::costs_points);
        if !wrong && report.submission.build_failure.is_none() {
            return Vec::new();
        }
        let graded = &self.techniques.graded;
        let is_everything = |direct: &ExplainedCause| graded.iter().all(|&it| direct.explains(it));
        let mut found = direct::causes(&self.techniques, report, source, starter);
        if !found.iter().any(is_everything) {
            found.extend(self.of_facts(report, &found));
        }
        let explained = |technique: Technique| found.iter().any(|direct| direct.explains(technique));
        let vector = ObservationVector::of(report, graded).without(explained);
        if !found.iter().any(is_everything) && !vector.all_pass() {
            found.extend(self.compared(report, &vector));
        }
        if found.is_empty() {
            found.extend(direct::constant_factor(report));
        }
        // Last, since it explains no failure of another technique.
        let bsdf = direct::bsdf_changed(report, graded);
        if found.is_empty() && (bsdf.is_none() || !vector.all_pass()) {
            let several_fit = rank::something_fits(self, &vector);
            let cause = report::Cause::Unknown { several_fit };
            let diagnosis = Diagnosis { cause, confidence: 0.0, seen: None };
            found.push(ExplainedCause { diagnosis, explains: Vec::new() });
        }
        found.truncate(MAX_CAUSES - usize::from(bsdf.is_some()));
        found.extend(bsdf);
        found.into_iter().map(|found| found.diagnosis).collect()
    }

    /// Failed facts of the audit, and the known mistake that has exactly these. They explain the failures of all
    /// techniques: what only looks similar could mislead.
    fn of_facts(&self, report: &Report, direct: &[ExplainedCause]) -> Vec<ExplainedCause> {
        let Some(audit) = &report.audit else { return Vec::new() };
        let is_explained = |technique: Technique| direct.iter().any(|direct| direct.explains(technique));
        let mut statements = audit.statements();
        statements.retain(|fact| !is_explained(fact.technique));
        let explains = self.techniques.graded.clone();
        let found = |cause: report::Cause| ExplainedCause {
            diagnosis: Diagnosis { cause, confidence: 1.0, seen: None },
            explains: explains.clone(),
        };
        let mut all: Vec<ExplainedCause> =
            statements.into_iter().map(|fact| found(report::Cause::FailedFact(fact.clone()))).collect();
        let exact = self.facts.exact(self, &FailedFact::all(audit));
        if let Some(Cause { id, title, hint, .. }) = exact.cloned() {
            all.insert(1.min(all.len()), found(report::Cause::Known { id, title, hint }));
        }
        all
    }

    /// Known mistakes whose pictures look alike. If all facts hold, a mistake that makes a fact fail is none of them.
    fn compared(&self, report: &Report, vector: &ObservationVector) -> Vec<ExplainedCause> {
        let is_possible = |cause: &Cause| {
            let holds = |variant: &String| self.facts.row(variant).is_none_or(|row| row.failed.is_empty());
            report.audit.is_none() || cause.variants.iter().any(holds)
        };
        let found = |candidate: &rank::Candidate<'_>| {
            let Cause { id, title, hint, .. } = candidate.cause.clone();
            let seen = seen::seen(self, report, vector, candidate);
            let cause = report::Cause::Known { id, title, hint };
            ExplainedCause {
                diagnosis: Diagnosis { cause, confidence: candidate.confidence, seen },
                explains: Vec::new(),
            }
        };
        let ranking = rank::rank(self, vector);
        ranking.iter().filter(|candidate| is_possible(candidate.cause)).map(found).collect()
    }

    /// Identifiers of the causes that [`Self::diagnose`] finds by comparison for an observation vector.
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

/// A cause, and the techniques whose failures it explains.
struct ExplainedCause {
    diagnosis: Diagnosis,
    /// The techniques whose failures it explains.
    explains: Vec<Technique>,
}

impl ExplainedCause {
    fn explains(&self, technique: Technique) -> bool {
        self.explains.contains(&technique)
    }
}
