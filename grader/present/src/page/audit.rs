//! The part of the page with the facts about every factor of the estimator.

use maud::{Markup, html};
use verdict::audit::{Audit, Fact, Outcome, Place};
use verdict::report::Report;

use super::prose::prose;
use crate::words::{self, fact};

/// One sentence per failed fact, the first of each term in view, and one row per factor; nothing if they were not measured.
pub(super) fn section(report: &Report) -> Markup {
    html! {
        @if let Some(audit) = &report.audit {
            section {
                h2 { "Factors of the estimator" }
                @let failed = audit.failed().count();
                p {
                    @if failed == 0 { "All " (audit.facts.len()) " facts are as they should be. " }
                    @else { (failed) " of " (words::count(audit.facts.len(), "fact")) " are not as they should be. " }
                    "Each value is the exponent of one factor in the result, or the result relative to the exact one, \
                    measured without noise in scripted scenes."
                }
                @if failed > 0 {
                    p { "The first one of each part of the estimator; the others often follow from these:" }
                    (sentences(&audit.statements()))
                    details {
                        summary { "All that is not as it should be" }
                        (sentences(&audit.failed().collect::<Vec<_>>()))
                    }
                }
                details {
                    summary { "All factors" }
                    (table(audit))
                }
            }
        }
    }
}

fn sentences(facts: &[&Fact]) -> Markup {
    html! { ul { @for fact in facts { li { (prose(&fact::fact(fact))) } } } }
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
