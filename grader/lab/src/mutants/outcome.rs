//! The grades of a variant compared with the expectation.

use super::{Kind, Record, Variant};

/// The grades of one variant over all seeds, compared with the expectation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outcome {
    /// Tasks that should lose points, and do not with every seed.
    pub missed: Vec<String>,
    /// Tasks that should keep all points, and do not with every seed.
    pub blamed: Vec<String>,
    /// Differences that `missed_because` does not announce, and announcements that are out of date.
    pub unexpected: Vec<String>,
    /// False if there is no grade to compare.
    pub graded: bool,
}

impl Outcome {
    /// Compares the grades of a variant with its expectation.
    pub fn new(variant: &Variant, records: &[&Record]) -> Self {
        let mut outcome = Self { graded: !records.is_empty(), ..Self::default() };
        if !outcome.graded {
            return outcome;
        }
        if let Some(messages) = records.iter().find_map(|record| record.build_failure.as_ref()) {
            outcome.unexpected.push(format!("it does not compile:\n{messages}"));
            return outcome;
        }
        let full = |record: &Record, task: &str| {
            record.tasks.get(task).is_some_and(|[earned, worth]| earned >= worth)
        };
        let count =
            |wanted: bool, task: &str| records.iter().filter(|record| full(record, task) == wanted).count();
        for task in &variant.costs {
            let keeping = count(true, task);
            outcome.note(variant, task, keeping, records.len(), "keeps all of its points");
            if keeping > 0 {
                outcome.missed.push(task.clone());
            }
        }
        for task in &variant.keeps {
            let losing = count(false, task);
            outcome.note(variant, task, losing, records.len(), "loses points");
            if losing > 0 {
                outcome.blamed.push(task.clone());
            }
        }
        outcome
    }

    fn note(&mut self, variant: &Variant, task: &str, against: usize, of: usize, what: &str) {
        match (against > 0, variant.missed_because.contains_key(task)) {
            (true, false) => self.unexpected.push(format!("{task} {what} ({against} of {of} seeds)")),
            (false, true) => self
                .unexpected
                .push(format!("{task} is as expected: remove its `missed_because` ({of} seeds)")),
            _ => {}
        }
    }

    /// Summary in a few words.
    pub fn word(&self, kind: Kind) -> String {
        if !self.graded {
            return "not graded".to_owned();
        }
        let mut words = Vec::new();
        if !self.missed.is_empty() {
            words.push(format!("missed in {}", self.missed.join(", ")));
        }
        if !self.blamed.is_empty() {
            words.push(format!("blamed in {}", self.blamed.join(", ")));
        }
        match (words.is_empty(), kind) {
            (false, _) => words.join("; "),
            (true, Kind::Wrong) => "caught".to_owned(),
            (true, Kind::Right) => "full points".to_owned(),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    fn variant(missed: &[&str]) -> Variant {
        Variant {
            id: "x".into(),
            kind: Kind::Wrong,
            rows: Vec::new(),
            title: String::new(),
            costs: vec!["a".into()],
            keeps: vec!["b".into()],
            missed_because: missed.iter().map(|&task| (task.into(), "because".into())).collect(),
            source: String::new(),
        }
    }

    fn record(a: f64, b: f64) -> Record {
        Record {
            key: String::new(),
            variant: "x".into(),
            seed: 1,
            tasks: BTreeMap::from([("a".into(), [a, 10.0]), ("b".into(), [b, 10.0])]),
            checks: BTreeMap::new(),
            build_failure: None,
            seconds: 1.0,
        }
    }

    #[test]
    fn a_variant_is_caught_if_every_seed_costs_the_right_task_and_no_other() {
        let good = record(9.5, 10.0);
        for (records, missed, word, unexpected) in [
            (vec![&good, &good], vec![], "caught", 0),
            (vec![&good, &record(10.0, 10.0)], vec![], "missed in a", 1),
            (vec![&good, &record(10.0, 10.0)], vec!["a"], "missed in a", 0),
            (vec![&record(0.0, 5.0)], vec![], "blamed in b", 1),
            (vec![&record(10.0, 0.0)], vec!["a", "b"], "missed in a; blamed in b", 0),
            (vec![&good], vec!["a"], "caught", 1),
            (vec![], vec!["a"], "not graded", 0),
        ] {
            let outcome = Outcome::new(&variant(&missed), &records);
            assert_eq!((outcome.word(Kind::Wrong).as_str(), outcome.unexpected.len()), (word, unexpected));
        }
    }
}
