//! The passages that two sources share, line by line.

use std::collections::BTreeMap;

use super::{GRAM, Starter, combine};
use crate::class::tokens::tokens;

/// For each line of a source the line of another one, both counted from 0, where the passage that it belongs to stands;
/// `None` for lines that are not shared.
pub(super) type Shared = Vec<Option<usize>>;

/// The shared lines of two sources. A passage is a run of at least [`GRAM`] tokens that differ in nothing but names,
/// literals, comments and layout, and that the starting file does not have.
pub(super) fn shared(starter: &Starter, one: &str, other: &str) -> [Shared; 2] {
    let sides = [one, other].map(|source| Side::new(starter, source));
    [marked(starter, &sides[0], &sides[1]), marked(starter, &sides[1], &sides[0])]
}

/// A source as it is compared.
struct Side {
    /// Line of each token, counted from 0.
    lines: Vec<usize>,
    /// Fingerprint of the run of tokens that begins at each token.
    grams: Vec<u64>,
    /// Number of lines.
    count: usize,
}

impl Side {
    fn new(starter: &Starter, source: &str) -> Self {
        let tokens = tokens(source, &starter.vocabulary);
        let hashes: Vec<u64> = tokens.iter().map(|token| token.hash).collect();
        Self {
            lines: tokens.iter().map(|token| token.line).collect(),
            grams: hashes.windows(GRAM).map(combine).collect(),
            count: source.lines().count(),
        }
    }
}

fn marked(starter: &Starter, own: &Side, other: &Side) -> Shared {
    let mut places: BTreeMap<u64, usize> = BTreeMap::new();
    for (place, gram) in other.grams.iter().enumerate() {
        places.entry(*gram).or_insert(place);
    }
    let mut shared = vec![None; own.count];
    for (start, gram) in own.grams.iter().enumerate() {
        let Some(place) = places.get(gram).filter(|_| !starter.grams.contains(gram)) else { continue };
        let lines = own.lines[start..start + GRAM].iter().zip(&other.lines[*place..place + GRAM]);
        for (line, there) in lines {
            if let Some(entry @ None) = shared.get_mut(*line) {
                *entry = Some(*there);
            }
        }
    }
    shared
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_shared_is_marked_on_both_sides_and_the_starting_file_is_not() {
        let given = "fn given(a: f32) -> f32 {\n    let b = a * 2.0 + 1.0;\n    b * b - a / 3.0\n}\n";
        let own =
            "fn own(x: f32, y: f32) -> f32 {\n    if x > y { x * x - y } else { (y - x) * (y + x) }\n}\n";
        let renamed = own.replace('x', "left").replace('y', "right").replace("own", "mine");
        let one = format!("{given}// a comment\n{own}");
        let other = format!("\n\n{renamed}fn different() {{}}\n{given}");
        let starter = Starter::new(given);
        let [left, right] = shared(&starter, &one, &other);
        assert_eq!(left, [None, None, None, None, None, Some(2), Some(3), Some(4)]);
        assert_eq!(right[..5], [None, None, Some(5), Some(6), Some(7)]);
        assert!(right[5..].iter().all(Option::is_none), "{right:?}");
        let [nothing, _] = shared(&starter, given, given);
        assert!(nothing.iter().all(Option::is_none));
    }
}
