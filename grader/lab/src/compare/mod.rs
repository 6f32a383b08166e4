//! Differences between two sets of grades, such as those before and after a change of the grader.

mod grades;

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use verdict::check::CheckId;

pub use grades::{Ending, Grade, GradeId, Grades};

/// Two sets of grades, compared submission by submission.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Comparison {
    /// Everything that differs, by submission.
    pub differences: Vec<Difference>,
    /// Submissions that only the first set has.
    pub only_before: Vec<GradeId>,
    /// Submissions that only the second set has.
    pub only_after: Vec<GradeId>,
    /// Number of submissions in both.
    pub submissions: usize,
    /// Number of checks of these submissions.
    pub checks: usize,
}

/// One difference between two grades of the same submission.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// The submission, as the first set calls it.
    pub grade: GradeId,
    /// The task.
    pub task: String,
    /// What differs.
    pub change: Change,
}

/// What differs between two grades. `None` where one of them does not have the check or the points.
#[derive(Clone, Debug, PartialEq)]
#[expect(missing_docs, reason = "the fields are before and after")]
pub enum Change {
    /// How a check ended.
    Verdict { check: CheckId, before: Option<Ending>, after: Option<Ending> },
    /// Points of a task.
    Points { before: Option<f64>, after: Option<f64> },
}

/// Differences of points up to this are rounding.
const ROUNDING: f64 = 1e-9;

impl Comparison {
    /// Compares two sets. A submission is the same in both if `renamed` maps its name in `before` to its name in `after`,
    /// or if the names are equal, a leading number such as `45-` aside.
    pub fn new(before: &Grades, after: &Grades, renamed: &BTreeMap<String, String>) -> Self {
        let mut comparison = Self::default();
        let mut matched = BTreeSet::new();
        for (id, earlier) in &before.0 {
            match counterpart(id, after, renamed).filter(|(other, _)| matched.insert((*other).clone())) {
                Some((_, later)) => comparison.compare(id, earlier, later),
                None => comparison.only_before.push(id.clone()),
            }
        }
        comparison.only_after = after.0.keys().filter(|id| !matched.contains(id)).cloned().collect();
        comparison
    }

    /// True if every submission of the first set is in the second, with the same verdicts and points.
    pub fn is_same(&self) -> bool {
        self.differences.is_empty() && self.only_before.is_empty()
    }

    fn compare(&mut self, grade: &GradeId, before: &Grade, after: &Grade) {
        let checks: BTreeSet<_> = before.checks.keys().chain(after.checks.keys()).collect();
        self.submissions += 1;
        self.checks += checks.len();
        let mut differs = |task: &String, change| {
            self.differences.push(Difference { grade: grade.clone(), task: task.clone(), change })
        };
        for key @ (task, check) in checks {
            let (before, after) = (before.checks.get(key).copied(), after.checks.get(key).copied());
            if before != after {
                differs(task, Change::Verdict { check: check.clone(), before, after });
            }
        }
        let tasks: BTreeSet<_> = before.points.keys().chain(after.points.keys()).collect();
        for task in tasks {
            let (before, after) = (before.points.get(task).copied(), after.points.get(task).copied());
            let is_same = match (before, after) {
                (Some(before), Some(after)) => (before - after).abs() <= ROUNDING,
                _ => before == after,
            };
            if !is_same {
                differs(task, Change::Points { before, after });
            }
        }
    }
}

/// The grade of the same submission with the same seed.
fn counterpart<'a>(
    id: &GradeId,
    grades: &'a Grades,
    renamed: &BTreeMap<String, String>,
) -> Option<(&'a GradeId, &'a Grade)> {
    let name = renamed.get(&id.name).unwrap_or(&id.name);
    let of_same_seed = || grades.0.iter().filter(|(other, _)| other.seed == id.seed);
    of_same_seed()
        .find(|(other, _)| other.name == *name)
        .or_else(|| of_same_seed().find(|(other, _)| without_number(&other.name) == without_number(name)))
}

/// A name without a leading number and dash.
fn without_number(name: &str) -> &str {
    match name.split_once('-') {
        Some((number, rest)) if !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit()) => {
            rest
        }
        _ => name,
    }
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fn or_dash(value: Option<&dyn fmt::Display>) -> String {
            value.map_or_else(|| "–".to_owned(), ToString::to_string)
        }
        let Self { grade, task, change } = self;
        match change {
            Change::Verdict { check, before, after } => {
                let [before, after] = [before, after]
                    .map(|ending| or_dash(ending.as_ref().map(|ending| ending as &dyn fmt::Display)));
                write!(f, "{grade}: {task} {check}: {before} → {after}")
            }
            Change::Points { before, after } => {
                let [before, after] = [before, after]
                    .map(|points| or_dash(points.as_ref().map(|points| points as &dyn fmt::Display)));
                write!(f, "{grade}: {task}: {before} → {after} points")
            }
        }
    }
}

impl fmt::Display for Comparison {
    /// One line per difference, the unmatched submissions, and a summary.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for difference in &self.differences {
            writeln!(f, "{difference}")?;
        }
        for (side, list) in [("before", &self.only_before), ("after", &self.only_after)] {
            for id in list {
                writeln!(f, "only {side}: {id}")?;
            }
        }
        let is_verdict = |difference: &&Difference| matches!(difference.change, Change::Verdict { .. });
        let verdicts = self.differences.iter().filter(is_verdict).count();
        let points = self.differences.len() - verdicts;
        write!(
            f,
            "{} variants, {} checks: {verdicts} verdicts differ, {points} points differ",
            grouped(self.submissions),
            grouped(self.checks)
        )?;
        if !(self.only_before.is_empty() && self.only_after.is_empty()) {
            write!(f, "; {} only before, {} only after", self.only_before.len(), self.only_after.len())?;
        }
        writeln!(f)
    }
}

/// A number with commas between thousands.
fn grouped(number: usize) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Name, points of the only task, checks.
    type Row<'a> = (&'a str, f64, &'a [(&'a str, Ending)]);

    fn grades(list: &[Row<'_>]) -> Grades {
        let grade = |&(name, points, checks): &Row<'_>| {
            let checks = checks
                .iter()
                .map(|(id, ending)| (("5.1a".to_owned(), id.parse().expect("it is an id")), *ending))
                .collect();
            (
                GradeId { name: name.into(), seed: 1 },
                Grade { points: [("5.1a".to_owned(), points)].into(), checks },
            )
        };
        Grades(list.iter().map(grade).collect())
    }

    #[test]
    fn every_difference_is_a_line_and_the_summary_counts_them() {
        const A: &str = "mean-bias/cornell_box/nee/1";
        const B: &str = "mean-bias/cornell_box/nee/8/emission-off";
        let before = grades(&[
            ("45-same", 20.0, &[(A, Ending::Pass)]),
            ("changed", 20.0, &[(A, Ending::Pass), (B, Ending::Inconclusive)]),
            ("old", 1.0, &[]),
            ("gone", 0.0, &[]),
        ]);
        let after = grades(&[
            ("same", 20.0, &[(A, Ending::Pass)]),
            ("changed", 0.0, &[(A, Ending::Fail), (B, Ending::Inconclusive)]),
            ("7-renamed", 1.0, &[(B, Ending::Skipped)]),
            ("added", 0.0, &[]),
        ]);
        let renamed = BTreeMap::from([("old".to_owned(), "renamed".to_owned())]);
        let comparison = Comparison::new(&before, &after, &renamed);
        assert!(!comparison.is_same());
        assert_eq!(
            comparison.to_string().lines().collect::<Vec<_>>(),
            [
                "changed, seed 1: 5.1a mean-bias/cornell_box/nee/1: pass → fail",
                "changed, seed 1: 5.1a: 20 → 0 points",
                "old, seed 1: 5.1a mean-bias/cornell_box/nee/8/emission-off: – → skipped",
                "only before: gone, seed 1",
                "only after: added, seed 1",
                "3 variants, 4 checks: 2 verdicts differ, 1 points differ; 1 only before, 1 only after",
            ]
        );
    }

    #[test]
    fn added_submissions_are_no_difference_and_lost_ones_are() {
        let (few, many) = (grades(&[("a", 1.0, &[])]), grades(&[("a", 1.0, &[]), ("b", 1.0, &[])]));
        assert!(Comparison::new(&few, &many, &BTreeMap::new()).is_same());
        assert!(!Comparison::new(&many, &few, &BTreeMap::new()).is_same());
    }

    #[test]
    fn only_a_leading_number_is_ignored_in_names() {
        for (name, expected) in
            [("45-a-b", "a-b"), ("a-45", "a-45"), ("-a", "-a"), ("45", "45"), ("4x-a", "4x-a")]
        {
            assert_eq!(without_number(name), expected);
        }
    }

    #[test]
    fn thousands_are_grouped() {
        assert_eq!([0, 999, 6412, 1_000_000].map(grouped), ["0", "999", "6,412", "1,000,000"]);
    }
}
