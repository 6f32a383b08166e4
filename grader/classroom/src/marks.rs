//! Marks: points that a tutor gave, stored beside the results so that grading again keeps them.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use verdict::error::{Error, Result};
use verdict::output;
use verdict::report::{Report, TaskState};
use verdict::rubric::Rubric;

/// A tutor's points for one task of one submission.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Mark {
    /// BLAKE3 of the submission's source, as in its report.
    pub submission: String,
    /// The task.
    pub task: String,
    /// The points.
    pub points: f64,
    /// Comment for the student.
    pub comment: String,
    /// Time of marking in UTC (RFC 3339).
    pub marked_at: String,
}

/// All marks of a result folder, stored in its `marks.json`.
#[derive(Debug)]
pub struct Marks {
    path: PathBuf,
    list: Vec<Mark>,
}

impl Marks {
    /// Reads the marks of a folder; none if it has no `marks.json` yet.
    ///
    /// # Errors
    /// If the file is there but cannot be read, or is not valid.
    pub fn open(folder: &Path) -> Result<Self> {
        let path = folder.join("marks.json");
        let list = match std::fs::read_to_string(&path) {
            Ok(text) => serde_json::from_str(&text).map_err(|error| Error::file(&path, error))?,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Vec::new(),
            Err(error) => return Err(Error::file(&path, error)),
        };
        Ok(Self { path, list })
    }

    /// Path of the file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Mark of a submission, given by its hash, for a task; `None` if there is none.
    pub fn find(&self, submission: &str, task: &str) -> Option<&Mark> {
        self.list.iter().find(|mark| mark.submission == submission && mark.task == task)
    }

    /// All marks of a submission, given by its hash.
    pub fn of<'a>(&'a self, submission: &'a str) -> impl Iterator<Item = &'a Mark> {
        self.list.iter().filter(move |mark| !submission.is_empty() && mark.submission == submission)
    }

    /// Adds a mark, or replaces the one for the same submission and task, and saves all marks.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn set(&mut self, mark: Mark) -> Result<()> {
        self.list.retain(|other| (&other.submission, &other.task) != (&mark.submission, &mark.task));
        self.list.push(mark);
        output::write_json(&self.path, &self.list)
    }

    /// Adds the marks of a report's submission to the report.
    pub fn apply(&self, report: &mut Report) {
        for task in &mut report.tasks {
            if let Some(mark) = self.find(&report.submission.hash, &task.id) {
                task.points = Some(mark.points);
                task.state = TaskState::ByHand { comment: Some(mark.comment.clone()) };
            }
        }
        let marked = self.of(&report.submission.hash);
        let (sum, count) = marked.fold((0.0, 0), |(sum, count), mark| (sum + mark.points, count + 1));
        report.points.manual = (count > 0).then_some(sum);
    }
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

    fn mark(points: f64) -> Mark {
        Mark {
            submission: "abc".into(),
            task: "5.2a".into(),
            points,
            comment: "names both".into(),
            marked_at: "2026-11-22T10:00:00Z".into(),
        }
    }

    #[test]
    fn the_last_mark_counts_and_is_kept() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let mut marks = Marks::open(folder.path()).expect("there are none");
        marks.set(mark(3.0)).expect("it can be written");
        marks.set(mark(8.0)).expect("it can be written");
        let again = Marks::open(folder.path()).expect("they are whole");
        assert_eq!(again.find("abc", "5.2a"), Some(&mark(8.0)));
        assert_eq!((again.list.len(), again.find("abc", "5.1a")), (1, None));
        std::fs::write(marks.path(), "[{").expect("it can be written");
        let message = Marks::open(folder.path()).expect_err("it is cut off").to_string();
        assert!(message.contains("marks.json"), "{message}");
    }
}
