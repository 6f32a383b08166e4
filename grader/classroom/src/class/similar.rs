//! Submissions that are the same or nearly so, for a tutor to look at. A student's report does not mention them.
//!
//! Sources are compared by fingerprints of their tokens: winnowing, as in Schleimer, Wilkerson and Aiken, "Winnowing:
//! local algorithms for document fingerprinting" (SIGMOD 2003), section 4. Any run of `GRAM + WINDOW - 1` tokens that
//! two files share leaves at least one common fingerprint. Fingerprints of the starting file are ignored. Similar files
//! prove nothing: the exercise is small, and there are few good solutions.

mod archive;
pub mod export;
pub mod page;
mod pairs;
mod passages;

use std::collections::{BTreeMap, BTreeSet};

pub use archive::{Archive, Earlier};
use serde::{Deserialize, Serialize};

use self::pairs::Pairs;
use super::tokens::{names, tokens};

/// Number of tokens in one fingerprint: about two statements.
const GRAM: usize = 16;
/// One of so many consecutive fingerprints is kept.
const WINDOW: usize = 6;
/// Minimum number of fingerprints that a file must have to be compared, not counting the starting file's.
const FEWEST: usize = 12;
/// Minimum share of common fingerprints of files that are listed. Solutions written independently share less than 0.05
/// (see the test), a copy with one changed expression most.
pub const THRESHOLD: f64 = 0.5;

/// Fingerprints and names of the starting file.
#[derive(Clone, Debug)]
pub struct Starter {
    vocabulary: BTreeSet<String>,
    grams: BTreeSet<u64>,
}

/// Fingerprint of a source.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Fingerprint {
    /// Hash of all tokens.
    whole: u64,
    /// Fingerprints that the starting file does not have, in order.
    pieces: Vec<u64>,
}

impl Starter {
    /// Computes them from its text.
    pub fn new(text: &str) -> Self {
        let vocabulary = names(text);
        let grams = grams(&hashes(text, &vocabulary)).into_iter().collect();
        Self { vocabulary, grams }
    }

    /// Computes the fingerprint of a source.
    pub fn fingerprint(&self, source: &str) -> Fingerprint {
        let tokens = hashes(source, &self.vocabulary);
        let grams = grams(&tokens);
        let mut pieces: Vec<u64> =
            grams.windows(WINDOW).filter_map(|window| window.iter().min().copied()).collect();
        pieces.retain(|piece| !self.grams.contains(piece));
        pieces.sort_unstable();
        pieces.dedup();
        Fingerprint { whole: combine(&tokens), pieces }
    }
}

fn hashes(source: &str, vocabulary: &BTreeSet<String>) -> Vec<u64> {
    tokens(source, vocabulary).into_iter().map(|token| token.hash).collect()
}

fn grams(tokens: &[u64]) -> Vec<u64> {
    tokens.windows(GRAM).map(combine).collect()
}

/// The first eight bytes of BLAKE3 over numbers.
fn combine(numbers: &[u64]) -> u64 {
    let mut hasher = blake3::Hasher::new();
    for number in numbers {
        hasher.update(&number.to_le_bytes());
    }
    let mut first = [0; 8];
    first.copy_from_slice(&hasher.finalize().as_bytes()[..8]);
    u64::from_le_bytes(first)
}

impl Fingerprint {
    /// Number of common fingerprints divided by the number of all, in [0, 1].
    pub fn similarity(&self, other: &Self) -> f64 {
        let (mut common, mut own, mut others) = (0_usize, 0, 0);
        while own < self.pieces.len() && others < other.pieces.len() {
            match self.pieces[own].cmp(&other.pieces[others]) {
                std::cmp::Ordering::Less => own += 1,
                std::cmp::Ordering::Greater => others += 1,
                std::cmp::Ordering::Equal => {
                    common += 1;
                    own += 1;
                    others += 1;
                }
            }
        }
        let all = self.pieces.len() + other.pieces.len() - common;
        if all == 0 { 0.0 } else { common as f64 / all as f64 }
    }
}

/// A group of similar submissions.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Group {
    /// True if they differ only in names, comments and layout.
    pub identical: bool,
    /// Students, by row key.
    pub students: Vec<String>,
    /// Similar pairs in a group that is not identical, with their similarity.
    pub pairs: Vec<(String, String, f64)>,
}

/// All groups with a submission of this year, identical ones first. Those of `earlier` years are compared with these, and
/// not with each other. Only the first of identical submissions is compared with others.
pub fn groups(
    submissions: &BTreeMap<String, Fingerprint>,
    earlier: &BTreeMap<String, Fingerprint>,
) -> Vec<Group> {
    let mut same: BTreeMap<u64, Same<'_>> = BTreeMap::new();
    for (of_this_year, prints) in [(true, submissions), (false, earlier)] {
        for (student, print) in prints.iter().filter(|(_, print)| print.pieces.len() >= FEWEST) {
            let entry = same.entry(print.whole).or_insert(Same { print, of_this_year, students: Vec::new() });
            entry.students.push(student);
        }
    }
    let mut groups: Vec<Group> = same
        .values()
        .filter(|same| same.of_this_year && same.students.len() > 1)
        .map(|same| Group {
            identical: true,
            students: same.students.iter().map(|&student| student.clone()).collect(),
            pairs: Vec::new(),
        })
        .collect();
    let different: Vec<&Same<'_>> = same.values().collect();
    let mut near = Pairs::new(different.len());
    for (index, one) in different.iter().enumerate() {
        for (after, other) in different[index + 1..].iter().enumerate() {
            if !(one.of_this_year || other.of_this_year) {
                continue;
            }
            let similarity = one.print.similarity(other.print);
            if similarity >= THRESHOLD {
                let rounded = (similarity * 1000.0).round() / 1000.0;
                near.add(index, index + 1 + after, rounded);
            }
        }
    }
    let mut near = near.groups(|index| different[index].students[0]);
    groups.sort_by(|one, other| one.students.cmp(&other.students));
    near.sort_by(|one, other| one.students.cmp(&other.students));
    groups.append(&mut near);
    groups
}

/// Submissions that differ in nothing but names, comments and layout.
struct Same<'a> {
    print: &'a Fingerprint,
    /// True if one of them is of this year; it comes first.
    of_this_year: bool,
    students: Vec<&'a String>,
}

/// Describes the groups in a text for staff.
pub fn describe(groups: &[Group]) -> String {
    let mut text =
        "Similar submissions, for a tutor to look at. Similarity proves nothing: the exercise is small.\n\
                    Tokens are compared, without names, comments, layout and the code of the starting file.\n"
            .to_owned();
    for group in groups {
        if group.identical {
            text +=
                &format!("\nthe same except for names, comments and layout: {}\n", group.students.join(", "));
            continue;
        }
        text += &format!("\nnearly the same: {}\n", group.students.join(", "));
        for (one, other, similarity) in &group.pairs {
            text += &format!("  {one} – {other}: {:.0} % in common\n", 100.0 * similarity);
        }
    }
    if groups.is_empty() {
        text += "\nnone\n";
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use harness::workspace::Workspace;

    fn read(path: &std::path::Path) -> String {
        std::fs::read_to_string(path).expect("it is there")
    }

    #[test]
    fn a_renamed_and_commented_copy_is_the_same_and_another_style_is_not() {
        let workspace = Workspace::find().expect("the tests run inside the checkout");
        let assignment =
            harness::assignment::Assignment::open(&workspace, "05-nee-mis").expect("it is sound");
        let starter_text = read(&assignment.folder.starter_file());
        let starter = Starter::new(&starter_text);
        let solution = assignment.solution().expect("it is there");
        let disguised = solution
            .replace("p_light(", "chance(")
            .replace("balance(", "heuristic(")
            .replace("    ", "\t")
            .replace('{', "{ // mine\n/// all mine\n");
        let styles = ["iterators", "path_state", "recursive", "separate_mis_ray"];
        let mut sources = BTreeMap::from([
            ("solution".to_owned(), solution),
            ("disguised".to_owned(), disguised),
            ("starter".to_owned(), starter_text.clone()),
            ("starter-2".to_owned(), starter_text),
        ]);
        for style in styles {
            sources.insert(style.to_owned(), read(&assignment.folder.variants().join(format!("{style}.rs"))));
        }
        let changed = sources["solution"].replace("hit.cos(wi) * weight / p_ne", "weight / p_ne");
        assert_ne!(changed, sources["solution"], "the solution has this expression");
        sources.insert("small-change".to_owned(), changed);
        let prints: BTreeMap<String, Fingerprint> =
            sources.iter().map(|(name, source)| (name.clone(), starter.fingerprint(source))).collect();
        let alike: Vec<(bool, Vec<String>)> = groups(&prints, &BTreeMap::new())
            .into_iter()
            .map(|group| (group.identical, group.students))
            .collect();
        let group = |names: &[&str]| names.iter().map(|&name| name.to_owned()).collect::<Vec<String>>();
        assert_eq!(
            alike,
            [(true, group(&["disguised", "solution"])), (false, group(&["disguised", "small-change"]))]
        );
        for style in styles {
            for (other, print) in prints.iter().filter(|(other, _)| *other != style) {
                let similarity = prints[style].similarity(print);
                assert!(similarity < 0.05, "{style} {other}: {similarity}");
            }
        }
    }

    #[test]
    fn earlier_years_are_compared_with_this_one_and_not_with_each_other() {
        let print = |whole: u64, first: u64| Fingerprint { whole, pieces: (first..first + 20).collect() };
        let this = BTreeMap::from([("ann".to_owned(), print(1, 0)), ("bob".to_owned(), print(2, 100))]);
        let earlier = [("2024/x", 3, 3), ("2024/y", 4, 200), ("2025/y", 4, 200), ("2025/b", 2, 100)];
        let earlier = earlier.map(|(key, whole, first)| (key.to_owned(), print(whole, first))).into();
        let found: Vec<_> =
            groups(&this, &earlier).into_iter().map(|group| group.students.join(" ")).collect();
        assert_eq!(found, ["bob 2025/b", "2024/x ann"]);
        assert_eq!(groups(&earlier, &this).len(), 3, "in their own year, they are a group");
    }

    #[test]
    fn what_is_no_rust_or_nested_without_end_is_compared_too() {
        let starter = Starter::new("fn main() {}");
        for source in
            ["(".repeat(400_000), format!("{}{}", "(".repeat(100_000), ")".repeat(100_000)), "\"".into()]
        {
            let _ = starter.fingerprint(&source);
        }
    }
}
