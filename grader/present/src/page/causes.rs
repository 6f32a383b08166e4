//! The part of the page that says what probably went wrong.

use maud::{Markup, html};

use verdict::report::Report;

/// Likely causes, each with the observation that decided and a hint; nothing if there are none.
pub(super) fn section(report: &Report) -> Markup {
    html! {
        @if !report.diagnosis.is_empty() {
            section {
                h2 { "What probably went wrong" }
                @for cause in &report.diagnosis {
                    h3 { (cause.heading()) }
                    @if !cause.evidence.is_empty() { p { "Seen: " (cause.evidence) } }
                    @if !cause.hint.is_empty() { p { "Think: " (cause.hint) } }
                }
            }
        }
    }
}
