//! The page of similar submissions, for staff: two sources side by side, with the passages that they share.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use maud::{Markup, html};

use super::archive::Earlier;
use super::passages::{Shared, shared};
use super::{Group, Starter};
use crate::class::record::ResultDir;
use present::page::document;
use present::words::count;
use verdict::error::Result;
use verdict::output;

/// Maximum number of pairs whose sources are on the page.
const SHOWN: usize = 50;

/// A pair of similar submissions, with the share of their fingerprints that is common.
type Pair<'a> = (&'a str, &'a str, f64);

/// Writes the page. `out` holds the results of the class. Sources that were not kept are left out, and the page says so.
///
/// # Errors
/// If it cannot be written.
pub fn save(path: &Path, out: &Path, starter: &Starter, groups: &[Group], earlier: &Earlier) -> Result<()> {
    let pairs = pairs(groups);
    let shown: Vec<Markup> = pairs
        .iter()
        .take(SHOWN)
        .enumerate()
        .map(|(number, pair)| section(number, pair, out, starter, &earlier.sources))
        .collect();
    let body = html! {
        main {
            h1 { "Similar submissions" }
            p { "For a tutor to look at, not for students. Similarity proves nothing: the exercise is small." }
            p.soft { "Tokens are compared, without names, comments, layout and the code of the starting file. Marked lines stand in both; "
                "a line's number leads to its counterpart." }
            @if pairs.is_empty() { p { "none" } }
            @if pairs.len() > SHOWN { p { "The " (SHOWN) " most similar of " (count(pairs.len(), "pair")) "." } }
            @for section in shown { (section) }
        }
    };
    let text = document::begin("Similar submissions", "") + &body.into_string() + &document::end("");
    output::write_bytes(path, text)
}

/// All pairs, the most similar first. Of submissions that are the same, each is paired with the first.
fn pairs(groups: &[Group]) -> Vec<Pair<'_>> {
    let mut pairs: Vec<Pair<'_>> = Vec::new();
    for group in groups {
        if let ([first, rest @ ..], true) = (group.students.as_slice(), group.identical) {
            pairs.extend(rest.iter().map(|other| (first.as_str(), other.as_str(), 1.0)));
        }
        pairs.extend(group.pairs.iter().map(|(one, other, share)| (one.as_str(), other.as_str(), *share)));
    }
    pairs.sort_by(|one, other| other.2.total_cmp(&one.2));
    pairs
}

fn section(
    number: usize,
    (one, other, share): &Pair<'_>,
    out: &Path,
    starter: &Starter,
    earlier: &BTreeMap<String, PathBuf>,
) -> Markup {
    let source = |name: &str| {
        let path = earlier.get(name).cloned().unwrap_or_else(|| ResultDir::new(out, name).source());
        std::fs::read_to_string(path)
    };
    html! {
        details open[number == 0] {
            summary { (one) " – " (other) ": " (format!("{:.0} %", 100.0 * share)) " in common" }
            @match (source(one), source(other)) {
                (Ok(left), Ok(right)) => {
                    @let [in_left, in_right] = shared(starter, &left, &right);
                    div.beside {
                        (column(&format!("{number}a"), &format!("{number}b"), one, &left, &in_left))
                        (column(&format!("{number}b"), &format!("{number}a"), other, &right, &in_right))
                    }
                }
                _ => p { "The source of one of them was not kept: only its fingerprints are known." }
            }
        }
    }
}

/// A source with its shared lines marked. Lines are named after `own`, and lead to those named after `other`.
fn column(own: &str, other: &str, title: &str, source: &str, shared: &Shared) -> Markup {
    html! {
        div style="max-width: none" {
            h3 { (title) }
            pre { @for (line, text) in source.lines().enumerate() {
                @let place = format!("{own}-{line}");
                @if let Some(there) = shared.get(line).copied().flatten() {
                    a id=(place) href={ "#" (other) "-" (there) } { (format!("{:4} ", line + 1)) } mark { (text) } "\n"
                } @else {
                    span.soft id=(place) { (format!("{:4} ", line + 1)) } (text) "\n"
                }
            } }
        }
    }
}
