//! The confusion matrix of the diagnosis.

use std::collections::BTreeMap;
use std::fmt::Write;

use super::{Catalogue, ObservationVector, UNKNOWN};

/// The diagnosis of a variant whose cause is known.
#[derive(Clone, Debug)]
pub struct Case {
    /// Name of the variant.
    pub variant: String,
    /// Seed of its grade.
    pub seed: u64,
    /// The right cause; `None` for a correct variant.
    pub truth: Option<String>,
    /// The diagnosed causes, most likely first.
    pub named: Vec<String>,
}

/// The diagnoses of all variants.
#[derive(Clone, Debug, Default)]
pub struct Confusion {
    /// One case per variant and seed.
    pub cases: Vec<Case>,
}

impl Confusion {
    /// Diagnoses the vector of a variant and adds the case.
    pub fn add(&mut self, catalogue: &Catalogue, variant: &str, seed: u64, vector: &ObservationVector) {
        self.cases.push(Case {
            variant: variant.to_owned(),
            seed,
            truth: catalogue.cause_of(variant).map(|cause| cause.id.clone()),
            named: catalogue.names(vector).into_iter().map(str::to_owned).collect(),
        });
    }

    /// Number of cases of wrong variants, of those with the right cause first, and of those with it among the causes.
    pub fn wrong(&self) -> [usize; 3] {
        let wrong = || self.cases.iter().filter(|case| case.truth.is_some());
        let first = wrong().filter(|case| case.named.first() == case.truth.as_ref()).count();
        let named =
            wrong().filter(|case| case.truth.as_ref().is_some_and(|it| case.named.contains(it))).count();
        [wrong().count(), first, named]
    }

    /// Number of cases of correct variants, and of those with a cause nevertheless.
    pub fn right(&self) -> [usize; 2] {
        let right = || self.cases.iter().filter(|case| case.truth.is_none());
        [right().count(), right().filter(|case| !case.named.is_empty()).count()]
    }

    /// The matrix as Markdown. `early` holds the cases of grades that stop each task after a number of failures, with
    /// that number.
    pub fn table(&self, made_by: &str, early: &[(usize, Self)]) -> String {
        let ([wrong, first, named], [right, blamed]) = (self.wrong(), self.right());
        let percent = |count: usize| 100.0 * count as f64 / wrong.max(1) as f64;
        let mut text = format!(
            "# Which cause is named for which mistake\n\nMade by `{made_by}`; do not edit. Signatures and cases are never of \
             the same grade.\n\n\
             - right cause first: {first} of {wrong} ({:.1} %)\n\
             - right cause among the first three: {named} of {wrong} ({:.1} %)\n\
             - a cause named for a correct submission: {blamed} of {right}\n",
            percent(first),
            percent(named),
        );
        for (failures, stopped) in early {
            let [_, first, named] = stopped.wrong();
            let _ = writeln!(
                text,
                "- if each task stops after {failures} checks that do not pass: first {first} ({:.1} %), among three {named} \
                 ({:.1} %)",
                percent(first),
                percent(named)
            );
        }
        text += "\n| cause | cases | first | named | named first instead |\n|---|--:|--:|--:|---|\n";
        let mut rows: BTreeMap<&str, Vec<&Case>> = BTreeMap::new();
        for case in &self.cases {
            if let Some(truth) = &case.truth {
                rows.entry(truth).or_default().push(case);
            }
        }
        for (truth, cases) in &rows {
            let first = |case: &&&Case| case.named.first().is_some_and(|it| it == truth);
            let named = cases.iter().filter(|case| case.named.iter().any(|it| it == truth)).count();
            let others: Vec<String> = cases
                .iter()
                .filter(|case| !first(case))
                .map(|case| {
                    let instead = case.named.first().map_or("nothing", String::as_str);
                    format!("{instead} ({}, seed {})", case.variant, case.seed)
                })
                .collect();
            let _ = writeln!(
                text,
                "| {truth} | {} | {} | {named} | {} |",
                cases.len(),
                cases.iter().filter(first).count(),
                others.join("; ")
            );
        }
        let unknown =
            self.cases.iter().filter(|case| case.named.first().is_some_and(|it| it == UNKNOWN)).count();
        let _ = writeln!(text, "\nUnknown: {unknown} of {} cases.", self.cases.len());
        text
    }
}
