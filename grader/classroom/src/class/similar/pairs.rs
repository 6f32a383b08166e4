//! Similar pairs, put together to groups.

use std::collections::BTreeMap;

use super::Group;

/// Similar pairs of submissions, by index, with their similarity.
pub(super) struct Pairs {
    pairs: Vec<(usize, usize, f64)>,
    /// Of each submission another of its group, or itself: following these ends at the same one for a whole group.
    towards: Vec<usize>,
}

impl Pairs {
    /// No pairs yet, of so many submissions.
    pub(super) fn new(submissions: usize) -> Self {
        Self { pairs: Vec::new(), towards: (0..submissions).collect() }
    }

    /// Adds a pair. All pairs that share a submission are of one group.
    pub(super) fn add(&mut self, one: usize, other: usize, similarity: f64) {
        let (end, other_end) = (self.end(one), self.end(other));
        self.towards[end] = other_end;
        self.pairs.push((one, other, similarity));
    }

    fn end(&mut self, mut index: usize) -> usize {
        while self.towards[index] != index {
            self.towards[index] = self.towards[self.towards[index]];
            index = self.towards[index];
        }
        index
    }

    /// The groups. `name` is the student whom a submission stands for.
    pub(super) fn groups<'a>(mut self, name: impl Fn(usize) -> &'a String) -> Vec<Group> {
        let mut groups: BTreeMap<usize, Vec<(String, String, f64)>> = BTreeMap::new();
        for (one, other, similarity) in std::mem::take(&mut self.pairs) {
            let end = self.end(one);
            let (one, other) = (name(one).min(name(other)), name(one).max(name(other)));
            groups.entry(end).or_default().push((one.clone(), other.clone(), similarity));
        }
        groups.into_values().map(group).collect()
    }
}

/// A group with its students and with the most similar pairs first.
fn group(mut pairs: Vec<(String, String, f64)>) -> Group {
    pairs.sort_by(|one, other| {
        other.2.total_cmp(&one.2).then_with(|| (&one.0, &one.1).cmp(&(&other.0, &other.1)))
    });
    let mut students: Vec<String> =
        pairs.iter().flat_map(|(one, other, _)| [one.clone(), other.clone()]).collect();
    students.sort();
    students.dedup();
    Group { identical: false, students, pairs }
}
