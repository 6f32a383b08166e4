//! Sentences with code in them.

use maud::{Markup, html};

/// A sentence with the text between pairs of backticks as code. Everything is escaped; a backtick without a partner, or
/// with nothing in between, is shown as it is.
pub(super) fn prose(text: &str) -> Markup {
    let mut rest = text;
    // Each span is plain text, then either a single backtick or code.
    let mut spans = Vec::new();
    while let Some((plain, after)) = rest.split_once('`') {
        let (span, next) = match after.split_once('`') {
            Some((code, next)) if !code.is_empty() => ((plain, "", code), next),
            _ => ((plain, "`", ""), after),
        };
        spans.push(span);
        rest = next;
    }
    html! {
        @for (plain, backtick, code) in spans {
            (plain) (backtick)
            @if !code.is_empty() { code { (code) } }
        }
        (rest)
    }
}

#[cfg(test)]
mod tests {
    use super::prose;

    #[test]
    fn backticks_become_code_and_everything_is_escaped() {
        for (text, expected) in [
            ("", ""),
            ("a < b", "a &lt; b"),
            ("in box (`nee`)", "in box (<code>nee</code>)"),
            ("`a` and `<b>`", "<code>a</code> and <code>&lt;b&gt;</code>"),
            ("one ` only", "one ` only"),
            ("`a` and ` only", "<code>a</code> and ` only"),
            ("a```b", "a```b"),
            ("`", "`"),
        ] {
            assert_eq!(prose(text).into_string(), expected);
        }
    }
}
