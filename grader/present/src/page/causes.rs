//! The part of the page that says what is probably wrong.

use maud::{Markup, html};

use super::prose::prose;
use crate::words::{heading, hint, seen};
use verdict::report::Report;

/// Likely causes, each with the observation that decided and a hint; nothing if there are none.
pub(super) fn section(report: &Report) -> Markup {
    html! {
        @if !report.diagnosis.is_empty() {
            section {
                h2 { "Likely causes" }
                @for diagnosis in &report.diagnosis {
                    @let (seen, hint) = (seen(report, diagnosis), hint(&diagnosis.cause));
                    h3 { (prose(&heading(diagnosis))) }
                    @if !seen.is_empty() { p { "Observed: " (prose(&seen)) } }
                    @if !hint.is_empty() { p { "Hint: " (prose(hint)) } }
                }
            }
        }
    }
}
