//! Marks: points that a tutor gave, stored beside the results so that grading again keeps them.
//!
//! A mark belongs to a student, a task and an explanation, never to a source: two students may hand in the same source
//! and explain it differently. If the explanation changes, its mark counts no longer.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::lock::FolderLock;
use verdict::error::{Error, Result};
use verdict::output;
use verdict::report::{Report, TaskState};
use verdict::rubric::Rubric;
use verdict::submission::Explanation;

/// Version of the format of `marks.json`.
const SCHEMA: &str = "arty-marks/2";

/// A tutor's points for one task of one student.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Mark {
    /// The student: the key of a row of the class, or the path of a submission that was graded alone.
    pub student: String,
    /// The task.
    pub task: String,
    /// [`fingerprint`] of the explanations that were marked.
    pub explanation: String,
    /// The points.
    pub points: f64,
    /// Comment for the student.
    pub comment: String,
    /// Time of marking in UTC (RFC 3339).
    pub marked_at: String,
}

/// Content of `marks.json`.
#[derive(Serialize, Deserialize)]
struct MarksFile {
    schema: String,
    marks: Vec<Mark>,
}

/// All marks of a result folder, stored in its `marks.json`.
#[derive(Debug)]
pub struct Marks {
    path: PathBuf,
    list: Vec<Mark>,
}

/// BLAKE3 of all explanations of a submission, in hexadecimal, whatever their names and order; empty if there are none.
pub fn fingerprint(explanations: &[Explanation]) -> String {
    let mut hashes: Vec<&str> = explanations.iter().map(|explanation| explanation.hash.as_str()).collect();
    hashes.sort_unstable();
    hashes.dedup();
    match hashes.as_slice() {
        [] => String::new(),
        hashes => blake3::hash(hashes.join("\n").as_bytes()).to_hex().to_string(),
    }
}

impl Marks {
    /// Reads the marks of a folder; none if it has no `marks.json` yet.
    ///
    /// # Errors
    /// If the file is there but cannot be read, or is not valid.
    pub fn open(folder: &Path) -> Result<Self> {
        let path = folder.join("marks.json");
        let list = match std::fs::read_to_string(&path) {
            Ok(text) => parse(&text).map_err(|message| Error::file(&path, message))?,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Vec::new(),
            Err(error) => return Err(Error::file(&path, error)),
        };
        Ok(Self { path, list })
    }

    /// Path of the file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Marks of a student for explanations with this [`fingerprint`].
    pub fn of<'a>(&'a self, student: &'a str, explanation: &'a str) -> impl Iterator<Item = &'a Mark> {
        self.list.iter().filter(move |mark| mark.student == student && mark.explanation == explanation)
    }

    /// Marks of a student for explanations that have been replaced since, in tasks without a newer mark.
    pub fn outdated<'a>(&'a self, student: &'a str, explanation: &'a str) -> impl Iterator<Item = &'a Mark> {
        let is_newer = move |task: &str| self.of(student, explanation).any(|mark| mark.task == task);
        let own = self.list.iter().filter(move |mark| mark.student == student);
        own.filter(move |mark| mark.explanation != explanation && !is_newer(&mark.task))
    }

    /// Adds marks to those of a folder and saves all of them. A mark replaces earlier ones of the same student, task and
    /// explanation. Several processes may do this at once.
    ///
    /// # Errors
    /// If the file cannot be read or written.
    pub fn add(folder: &Path, added: Vec<Mark>) -> Result<Self> {
        let _lock = FolderLock::of_marks(folder)?;
        let mut marks = Self::open(folder)?;
        for mark in added {
            let same = |other: &Mark| {
                (&other.student, &other.task, &other.explanation)
                    == (&mark.student, &mark.task, &mark.explanation)
            };
            marks.list.retain(|other| !same(other));
            marks.list.push(mark);
        }
        let file = MarksFile { schema: SCHEMA.to_owned(), marks: marks.list };
        output::write_json(&marks.path, &file)?;
        Ok(Self { list: file.marks, ..marks })
    }

    /// Adds the marks of a student to the report on the student's submission.
    pub fn apply(&self, report: &mut Report, student: &str) {
        let explanation = fingerprint(&report.submission.explanations);
        let (mut sum, mut count) = (0.0, 0);
        for mark in self.of(student, &explanation) {
            if let Some(task) = report.tasks.iter_mut().find(|task| task.id == mark.task) {
                task.points = Some(mark.points);
                task.state = TaskState::ByHand { comment: Some(mark.comment.clone()) };
                sum += mark.points;
                count += 1;
            }
        }
        report.points.manual = (count > 0).then_some(sum);
    }
}

fn parse(text: &str) -> std::result::Result<Vec<Mark>, String> {
    let value: serde_json::Value = serde_json::from_str(text).map_err(|error| error.to_string())?;
    if value.get("schema").and_then(|schema| schema.as_str()) != Some(SCHEMA) {
        return Err(format!(
            "these marks are not of the format {SCHEMA}; older ones were stored by source, which two students may \
             share: move the file away and enter them again with `cargo grader mark`"
        ));
    }
    serde_json::from_value::<MarksFile>(value).map(|file| file.marks).map_err(|error| error.to_string())
}

/// Error message if a task cannot be marked with so many points; `None` if it can.
pub fn why_not(rubric: &Rubric, task: &str, points: f64) -> Option<String> {
    let manual: Vec<&str> =
        rubric.tasks.iter().filter(|task| task.manual).map(|task| task.id.as_str()).collect();
    let Some(found) = rubric.tasks.iter().find(|other| other.id == task) else {
        return Some(format!("there is no task `{task}`; tutors mark {}", manual.join(", ")));
    };
    if !found.manual {
        return Some(format!("task {task} is graded automatically; tutors mark {}", manual.join(", ")));
    }
    let fits = (0.0..=found.points).contains(&points);
    (!fits).then(|| format!("task {task} is worth 0 to {} points", found.points))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mark(student: &str, explanation: &str, points: f64) -> Mark {
        Mark {
            student: student.into(),
            task: "5.2a".into(),
            explanation: explanation.into(),
            points,
            comment: "names both".into(),
            marked_at: "2026-11-22T10:00:00Z".into(),
        }
    }

    fn points(marks: &Marks, student: &str, explanation: &str) -> Vec<f64> {
        marks.of(student, explanation).map(|mark| mark.points).collect()
    }

    #[test]
    fn the_last_mark_of_a_student_counts_for_the_explanation_that_was_marked() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        Marks::add(folder.path(), vec![mark("ann", "e", 3.0), mark("bob", "", 1.0)])
            .expect("it can be written");
        Marks::add(folder.path(), vec![mark("ann", "e", 8.0)]).expect("it can be written");
        let marks = Marks::open(folder.path()).expect("they are whole");
        assert_eq!(points(&marks, "ann", "e"), [8.0]);
        assert_eq!(points(&marks, "bob", ""), [1.0]);
        assert_eq!(points(&marks, "bob", "e"), [] as [f64; 0], "the same explanation of somebody else");
        assert_eq!(marks.outdated("ann", "e").count(), 0);
        assert_eq!(marks.outdated("ann", "other").count(), 1, "the explanation has changed");
        for wrong in ["[{", "[]", "{\"schema\": \"arty-marks/1\"}"] {
            std::fs::write(marks.path(), wrong).expect("it can be written");
            let message = Marks::open(folder.path()).expect_err("it is none of ours").to_string();
            assert!(message.contains("marks.json"), "{message}");
        }
    }

    #[test]
    fn marks_that_are_entered_at_once_are_all_kept() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        std::thread::scope(|scope| {
            for index in 0..16 {
                let folder = folder.path();
                scope.spawn(move || Marks::add(folder, vec![mark(&format!("s{index}"), "", 1.0)]));
            }
        });
        let marks = Marks::open(folder.path()).expect("they are whole");
        assert_eq!(marks.list.len(), 16);
    }
}
