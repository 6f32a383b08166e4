//! Sentences with code in them.

use maud::{Markup, html};

/// A sentence with the text between pairs of backticks as code. Everything is escaped; a backtick without a partner
/// is shown as it is.
pub(super) fn prose(text: &str) -> Markup {
    let parts: Vec<&str> = text.split('`').collect();
    html! {
        @for (index, part) in parts.iter().enumerate() {
            @if index % 2 == 0 { (part) } @else if index + 1 < parts.len() { code { (part) } } @else { "`" (part) }
        }
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
            ("`", "`"),
        ] {
            assert_eq!(prose(text).into_string(), expected);
        }
    }
}
