//! The part of the page that a student reads first: one step, and what to do.

use maud::{Markup, html};

use super::prose::prose;
use crate::words;
use verdict::report::Report;

/// The next step with its hint and the command that shows it again; what to do when there is none.
pub(super) fn section(report: &Report) -> Markup {
    let Some(next) = report.next() else {
        return html! { @if let Some(text) = words::finish(report) { p.next { (prose(&text)) } } };
    };
    let done = words::steps_done(report, next.task);
    html! {
        section.next {
            h2 { (words::next_heading(&next)) }
            @if !done.is_empty() { p.pass { (done) } }
            p { b { (next.check.id) } ": " (prose(&words::explanation(next.check))) "." }
            @if let Some(diagnosis) = next.cause {
                p { (prose(&words::heading(diagnosis))) }
                @let hint = words::hint(&diagnosis.cause);
                @if !hint.is_empty() { p { "Hint: " (prose(hint)) } }
            }
            p { code.command { @match words::replay_of(next.check, &report.submission.path) {
                Some(replay) => (replay),
                None => (words::repeat_command(report, &next.check.id)),
            } } }
            @if let Some(note) = words::prints(&report.submission.file_name, &report.submission.prints) { p.soft { (prose(&note)) } }
        }
    }
}
