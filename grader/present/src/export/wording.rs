//! What all formats say alike.

use verdict::report::{Points, Verdict};

/// The outcome in a word.
pub(super) fn word(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Pass => "pass",
        Verdict::Fail => "fail",
        Verdict::Inconclusive => "inconclusive",
        Verdict::LeftOut => "left out",
        Verdict::Error => "error",
    }
}

/// What the sum of points does not cover; empty if it covers everything.
pub(super) fn not_covered(points: &Points) -> String {
    let mut parts = Vec::new();
    if points.elsewhere > 0.0 {
        parts.push(format!("{} points rest on checks that only your tutors can run", points.elsewhere));
    }
    if points.manual_max > 0.0 {
        parts.push(format!("{} more are marked by a person", points.manual_max));
    }
    parts.join("; ")
}

/// The beginning of a text that someone may have made very long.
pub(super) fn shortened(text: &str, characters: usize) -> String {
    match text.char_indices().nth(characters) {
        Some((end, _)) => format!("{} …", &text[..end]),
        None => text.to_owned(),
    }
}
