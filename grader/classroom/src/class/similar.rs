//! Submissions that are the same or nearly so, for a tutor to look at. A student's report does not mention them.
//!
//! Sources are compared by fingerprints of their tokens: winnowing, as in Schleimer, Wilkerson and Aiken, "Winnowing:
//! local algorithms for document fingerprinting" (SIGMOD 2003), section 4. Any run of `GRAM + WINDOW - 1` tokens that
//! two files share leaves at least one common fingerprint. Fingerprints of the starting file are ignored. Similar files
//! prove nothing: the exercise is small, and there are few good solutions.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};

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
        let grams = grams(&tokens(text, &vocabulary)).into_iter().collect();
        Self { vocabulary, grams }
    }

    /// Computes the fingerprint of a source.
    pub fn fingerprint(&self, source: &str) -> Fingerprint {
        let tokens = tokens(source, &self.vocabulary);
        let grams = grams(&tokens);
        let mut pieces: Vec<u64> =
            grams.windows(WINDOW).filter_map(|window| window.iter().min().copied()).collect();
        pieces.retain(|piece| !self.grams.contains(piece));
        pieces.sort_unstable();
        pieces.dedup();
        Fingerprint { whole: combine(&tokens), pieces }
    }
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

/// All groups, identical ones first. Only the first of identical submissions is compared with others.
pub fn groups(submissions: &BTreeMap<String, Fingerprint>) -> Vec<Group> {
    let mut same: BTreeMap<u64, Vec<&String>> = BTreeMap::new();
    let comparable = submissions.iter().filter(|(_, print)| print.pieces.len() >= FEWEST);
    for (student, print) in comparable {
        same.entry(print.whole).or_default().push(student);
    }
    let mut groups: Vec<Group> = same
        .values()
        .filter(|students| students.len() > 1)
        .map(|students| Group {
            identical: true,
            students: students.iter().map(|&student| student.clone()).collect(),
            pairs: Vec::new(),
        })
        .collect();
    let first: Vec<&String> = same.values().map(|students| students[0]).collect();
    let mut near: Vec<Group> = Vec::new();
    for (index, one) in first.iter().enumerate() {
        for other in &first[index + 1..] {
            let similarity = submissions[*one].similarity(&submissions[*other]);
            if similarity >= THRESHOLD {
                let rounded = (similarity * 1000.0).round() / 1000.0;
                let (one, other) = (one.min(other), one.max(other));
                join(&mut near, ((*one).clone(), (*other).clone(), rounded));
            }
        }
    }
    for group in &mut near {
        group.students =
            group.pairs.iter().flat_map(|(one, other, _)| [one.clone(), other.clone()]).collect();
        group.students.sort();
        group.students.dedup();
        group.pairs.sort_by(|one, other| other.2.total_cmp(&one.2).then_with(|| one.0.cmp(&other.0)));
    }
    groups.sort_by(|one, other| one.students.cmp(&other.students));
    near.sort_by(|one, other| one.students.cmp(&other.students));
    groups.append(&mut near);
    groups
}

/// Adds a pair, and merges all groups that contain one of its students.
fn join(groups: &mut Vec<Group>, pair: (String, String, f64)) {
    let has = |group: &Group| {
        group
            .pairs
            .iter()
            .any(|(one, other, _)| [one, other].iter().any(|name| **name == pair.0 || **name == pair.1))
    };
    let (touched, rest): (Vec<Group>, Vec<Group>) = std::mem::take(groups).into_iter().partition(has);
    *groups = rest;
    let mut pairs: Vec<_> = touched.into_iter().flat_map(|group| group.pairs).collect();
    pairs.push(pair);
    groups.push(Group { identical: false, students: Vec::new(), pairs });
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
        let assignment = workspace.assignment("05-nee-mis");
        let starter_text = read(&assignment.starter_file());
        let starter = Starter::new(&starter_text);
        let solution = read(&workspace.solution_file());
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
            sources.insert(style.to_owned(), read(&assignment.variants().join(format!("{style}.rs"))));
        }
        let changed = sources["solution"].replace("hit.cos(wi) * weight / p_ne", "weight / p_ne");
        assert_ne!(changed, sources["solution"], "the solution has this expression");
        sources.insert("small-change".to_owned(), changed);
        let prints: BTreeMap<String, Fingerprint> =
            sources.iter().map(|(name, source)| (name.clone(), starter.fingerprint(source))).collect();
        let alike: Vec<(bool, Vec<String>)> =
            groups(&prints).into_iter().map(|group| (group.identical, group.students)).collect();
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
    fn what_is_no_rust_or_nested_without_end_is_compared_too() {
        let starter = Starter::new("fn main() {}");
        for source in
            ["(".repeat(400_000), format!("{}{}", "(".repeat(100_000), ")".repeat(100_000)), "\"".into()]
        {
            let _ = starter.fingerprint(&source);
        }
    }
}
