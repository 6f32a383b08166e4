//! The part of the page with the facts about every factor of the estimator.

use maud::{Markup, html};
use verdict::audit::{Audit, Fact, Outcome, Place};
use verdict::report::Report;

use super::prose::prose;
use crate::words::{self, fact};

/// One row per factor, and one sentence per failed fact; nothing if they were not measured.
pub(super) fn section(report: &Report) -> Markup {
    html! {
        @if let Some(audit) = &report.audit {
            section {
                h2 { "Factors of the estimator" }
                p {
                    (words::count(audit.failed().count(), "fact")) " of " (audit.facts.len()) " not as it should be. \
                    Each value is the exponent of one factor in the result, or the result relative to the exact one, \
                    measured without noise in scripted scenes."
                }
                @if audit.failed().next().is_some() {
                    ul { @for failed in audit.failed() { li { (prose(&fact::fact(failed))) } } }
                }
                details {
                    summary { "All factors" }
                    (table(audit))
                }
            }
        }
    }
}

fn table(audit: &Audit) -> Markup {
    html! {
        table {
            thead { tr { th { "factor" } th { "should be" } th { "1st hit" } th { "2nd" } th { "3rd" } } }
            tbody {
                @for row in words::audit_rows(audit) {
                    tr {
                        td {
                            (fact::heading(row[0].term)) " (" code { (row[0].technique) } "): " (fact::factor(row[0]))
                        }
                        td { (fact::expected(row[0])) }
                        @for hit in 1..=3 { td { (cell(&row, hit)) } }
                    }
                }
            }
        }
    }
}

fn cell(row: &[&Fact], hit: u32) -> Markup {
    let at_hit = row.iter().find(|fact| fact.place == Place::Hit(hit));
    let fact = at_hit.or_else(|| (hit == 1 && !matches!(row[0].place, Place::Hit(_))).then_some(&row[0]));
    html! {
        @if let Some(fact) = fact {
            @match fact.outcome {
                Outcome::Fails => strong { (fact::measured(fact)) " ✗" },
                _ => (fact::measured(fact)),
            }
        }
    }
}
