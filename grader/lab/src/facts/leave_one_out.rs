//! How a mistake is explained that nobody has seen before.
//!
//! For each known mistake, all of its variants are left out of the table of facts. The first statement about each is
//! then compared with what is wrong: `facts` of its cause in causes.yml, which was written by hand.

use std::fmt::Write;

use judge::diagnosis::{Catalogue, LearntFacts};

use crate::mutants::{Kind, Variant};

/// How the first statement about a variant compares with its mistake.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Judgement {
    /// It is about the factor that is wrong.
    Right,
    /// It is about the same term, and another of its factors.
    Plausible,
    /// No fact fails.
    Unknown,
    /// It is about another term.
    Misleading,
}

impl Judgement {
    const ALL: [Self; 4] = [Self::Right, Self::Plausible, Self::Unknown, Self::Misleading];

    fn name(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::Plausible => "plausible",
            Self::Unknown => "unknown",
            Self::Misleading => "misleading",
        }
    }
}

/// The table as Markdown.
pub fn leave_one_out(catalogue: &Catalogue, learnt: &LearntFacts, variants: &[Variant]) -> String {
    let mut rows = Vec::new();
    let mut blamed = 0;
    for variant in variants {
        let Some(row) = learnt.row(&variant.id) else { continue };
        let Some(cause) = catalogue.cause_of(&variant.id) else {
            blamed += usize::from(variant.kind == Kind::Right && !row.failed.is_empty());
            continue;
        };
        let first = row.failed.first().map(|failed| failed.0.as_str());
        let others = learnt.without(&cause.variants);
        let named = others.exact(catalogue, &row.failed).map(|cause| cause.id.as_str());
        rows.push((variant.id.as_str(), judge(&cause.facts, first), first, named));
    }
    let count = |judgement| rows.iter().filter(|row| row.1 == judgement).count();
    let mut text = String::from(
        "# First statements about mistakes never seen before\n\nMade by `cargo lab leave-one-out`; do not edit. Each known \
         mistake is left out of the table of facts while it is diagnosed. Only facts count: no pictures, no signatures.\n\n",
    );
    for judgement in Judgement::ALL {
        let percent = 100.0 * count(judgement) as f64 / rows.len().max(1) as f64;
        let _ =
            writeln!(text, "- {}: {} of {} ({percent:.1} %)", judgement.name(), count(judgement), rows.len());
    }
    let also = rows.iter().filter(|row| row.3.is_some()).count();
    let _ = writeln!(text, "- another known mistake has the same failed facts with the same values: {also}");
    let _ = writeln!(text, "- correct variants with a failed fact: {blamed}\n");
    text += "*Right*: the first failed fact is about the factor that is wrong (`facts` in causes.yml). *Plausible*: about another \
             factor of the same term. *Misleading*: about another term.\n\n";
    text += "| variant | first statement | judgement | same facts as |\n|---|---|---|---|\n";
    for (variant, judgement, first, named) in rows {
        let (first, named) = (first.unwrap_or("–"), named.unwrap_or(""));
        let _ = writeln!(text, "| {variant} | {first} | {} | {named} |", judgement.name());
    }
    text
}

fn judge(expected: &[String], first: Option<&str>) -> Judgement {
    let Some(first) = first else { return Judgement::Unknown };
    let term = |id: &str| id.split('/').next().unwrap_or_default().to_owned();
    if expected.iter().any(|prefix| first.starts_with(prefix.as_str())) {
        Judgement::Right
    } else if expected.iter().any(|prefix| term(prefix) == term(first)) {
        Judgement::Plausible
    } else {
        Judgement::Misleading
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_statement_is_right_about_the_factor_and_misleading_about_another_term() {
        let expected = ["hit-weight/distance".to_owned()];
        for (first, judgement) in [
            (Some("hit-weight/distance/mis/1"), Judgement::Right),
            (Some("hit-weight/lights/mis/1"), Judgement::Plausible),
            (Some("roulette/grey-throughput/nee"), Judgement::Misleading),
            (None, Judgement::Unknown),
        ] {
            assert_eq!(judge(&expected, first), judgement, "{first:?}");
        }
    }
}
