//! Where a report is exported: what formats need to know beside it.

use std::collections::BTreeMap;
use std::path::Path;

use jiff::Timestamp;
use serde::Deserialize;

use verdict::error::{Error, Result};
use verdict::report::Report;
use verdict::submission::Submission;

/// What a format may need beside the report.
#[derive(Clone, Debug, Default)]
pub struct Surroundings {
    /// The environment.
    pub environment: BTreeMap<String, String>,
    /// When the report is exported.
    pub now: Option<Timestamp>,
    /// The file of the submission, relative to the checkout of the CI system, if it is within.
    pub file: String,
    /// Lines of the submission, counted from 1, at which the tasks begin, by the tasks' names.
    pub lines: BTreeMap<String, usize>,
    /// When Gradescope received the submission.
    pub received: Option<Received>,
}

/// When a submission came and was due: the contents of Gradescope's `submission_metadata.json`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Received {
    /// When it came.
    pub created_at: Timestamp,
    /// When it was due: the latest date of its authors.
    pub due: Option<Timestamp>,
}

/// The part of `submission_metadata.json` that is read.
#[derive(Deserialize)]
struct Metadata {
    created_at: Timestamp,
    #[serde(default)]
    assignment: Assignment,
    #[serde(default)]
    users: Vec<User>,
}

#[derive(Default, Deserialize)]
struct Assignment {
    due_date: Option<Timestamp>,
}

#[derive(Deserialize)]
struct User {
    #[serde(default)]
    assignment: Assignment,
}

impl Received {
    /// Reads `submission_metadata.json`.
    ///
    /// # Errors
    /// If it is not that.
    pub fn load(path: &Path) -> Result<Self> {
        let bytes = std::fs::read(path).map_err(|error| Error::file(path, error))?;
        let metadata: Metadata = serde_json::from_slice(&bytes).map_err(|error| Error::file(path, error))?;
        // A student with an extension has a date of their own.
        let own = metadata.users.iter().filter_map(|user| user.assignment.due_date).max();
        Ok(Self { created_at: metadata.created_at, due: own.or(metadata.assignment.due_date) })
    }
}

impl Surroundings {
    /// Those of this process; `submission` is what the report is about, if its source is still there.
    pub fn here(report: &Report, submission: Option<&Submission>) -> Self {
        let environment: BTreeMap<String, String> = std::env::vars_os()
            .filter_map(|(name, value)| Some((name.into_string().ok()?, value.into_string().ok()?)))
            .collect();
        let path = Path::new(&report.submission.path);
        let file = environment
            .get("GITHUB_WORKSPACE")
            .and_then(|root| Path::new(root).canonicalize().ok())
            .and_then(|root| Some(path.canonicalize().ok()?.strip_prefix(root).ok()?.to_owned()))
            .unwrap_or_else(|| path.to_owned());
        // Only if it is still the file that was graded, the lines mean something.
        let source = submission.filter(|source| source.hash() == report.submission.hash);
        let lines = source.map(|submission| task_lines(&submission.source, report)).unwrap_or_default();
        let file = file.to_string_lossy().replace('\\', "/");
        Self { environment, now: Some(Timestamp::now()), file, lines, received: None }
    }

    /// A variable of the environment, or nothing.
    pub(super) fn variable(&self, name: &str) -> &str {
        self.environment.get(name).map_or("", String::as_str)
    }
}

/// The first mark of each task, as in `// TASK 1a, 2b: …`.
fn task_lines(source: &str, report: &Report) -> BTreeMap<String, usize> {
    let mut lines = BTreeMap::new();
    for (index, line) in source.lines().enumerate() {
        let Some(mark) = line.trim_start().strip_prefix("// TASK") else { continue };
        let names = mark.split(':').next().unwrap_or_default();
        for name in names.split(|c: char| c == ',' || c.is_whitespace()) {
            if report.tasks.iter().any(|task| task.id == name) {
                lines.entry(name.to_owned()).or_insert(index + 1);
            }
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use verdict::sample::report;

    #[test]
    fn tasks_are_found_at_their_marks() {
        let lines = task_lines("a\n  // TASK 9, 5.1a: what?\n// TASK 5.1a: again\n", &report("x"));
        assert_eq!(lines, BTreeMap::from([("5.1a".to_owned(), 2)]));
    }

    #[test]
    fn gradescope_names_the_date_that_holds_for_the_student() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let file = folder.path().join("submission_metadata.json");
        let load = |text: &str| {
            std::fs::write(&file, text).expect("it can be written");
            Received::load(&file)
        };
        let received = load(
            r#"{"id": 1, "created_at": "2026-11-20T10:00:00.5-08:00",
                "assignment": {"due_date": "2026-11-19T10:00:00-08:00", "title": "x"},
                "users": [{"email": "a@b", "assignment": {"due_date": "2026-11-21T10:00:00-08:00"}}]}"#,
        )
        .expect("it is as documented");
        assert!(received.due.is_some_and(|due| due > received.created_at), "{received:?}");
        let received = load(r#"{"created_at": "2026-11-20T10:00:00Z"}"#).expect("nothing else is needed");
        assert_eq!(received.due, None);
        assert!(load("{}").is_err() && load("").is_err());
    }
}
