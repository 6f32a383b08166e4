//! The folder of an assignment, and the paths of its files.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use verdict::error::{Error, Result};
use verdict::rubric::Rubric;

/// The folder of an assignment. Everything that belongs to one assignment only is in it.
#[derive(Clone, Debug)]
pub struct AssignmentFolder {
    path: PathBuf,
}

impl AssignmentFolder {
    /// The assignment in a folder.
    pub fn new(path: impl Into<PathBuf>) -> Self {
        Self { path: path.into() }
    }

    /// The folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Tasks, points, checks.
    pub fn rubric_file(&self) -> PathBuf {
        self.path.join("rubric.yml")
    }

    /// Reads the rubric.
    ///
    /// # Errors
    /// If it cannot be read, or is wrong.
    pub fn rubric(&self) -> Result<Rubric> {
        Rubric::load(&self.rubric_file())
    }

    /// The exercise.
    pub fn sheet(&self) -> PathBuf {
        self.path.join("sheet.md")
    }

    /// Folder of the pictures of the sheet.
    pub fn figures(&self) -> PathBuf {
        self.path.join("figures")
    }

    /// Deadline and extensions of a course; need not exist.
    pub fn course_file(&self) -> PathBuf {
        self.path.join("course.yml")
    }

    /// The student's file as it was handed out.
    pub fn starter_file(&self) -> PathBuf {
        self.path.join("starter.rs")
    }

    /// Text of the starting file; empty if the assignment has none.
    ///
    /// # Errors
    /// If the file exists and cannot be read as UTF-8.
    pub fn starter(&self) -> Result<String> {
        let path = self.starter_file();
        match std::fs::read_to_string(&path) {
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(String::new()),
            text => text.map_err(|error| Error::file(&path, error)),
        }
    }

    /// Phrases of the solution that a handout may contain; need not exist.
    pub fn leaks_file(&self) -> PathBuf {
        self.path.join("leaks.yml")
    }

    /// Folder of files that take the place of those of the checkout in a handout; need not exist.
    pub fn overlay(&self) -> PathBuf {
        self.path.join("overlay")
    }

    /// What the figures of the sheet show; need not exist.
    pub fn figures_file(&self) -> PathBuf {
        self.path.join("figures.yml")
    }

    /// Known mistakes, described for students.
    pub fn causes_file(&self) -> PathBuf {
        self.path.join("causes.yml")
    }

    /// What the known mistakes look like to the checks.
    pub fn signatures_file(&self) -> PathBuf {
        self.path.join("signatures.json")
    }

    /// The facts of the audit that fail for the known mistakes.
    pub fn facts_file(&self) -> PathBuf {
        self.path.join("facts.json")
    }

    /// Folder of the variants: versions of the solution with known mistakes, correct ones, and what was measured with
    /// them. It stays with the staff.
    pub fn variants(&self) -> PathBuf {
        self.path.join("variants")
    }

    /// Table of the checks that each variant fails.
    pub fn kill_matrix(&self) -> PathBuf {
        self.variants().join("kill-matrix.md")
    }

    /// Table of first statements about mistakes that are left out of what is known.
    pub fn leave_one_out_table(&self) -> PathBuf {
        self.variants().join("leave-one-out.md")
    }

    /// Table of how often the right cause is named.
    pub fn confusion_table(&self) -> PathBuf {
        self.variants().join("confusion.md")
    }

    /// The observations that the confusion table is made from.
    pub fn confusion_data(&self) -> PathBuf {
        self.variants().join("confusion.json")
    }

    /// Table of how often correct submissions fail.
    pub fn calibration_table(&self) -> PathBuf {
        self.variants().join("calibration.md")
    }

    /// Plot of the calibration table.
    pub fn calibration_plot(&self) -> PathBuf {
        self.variants().join("calibration.svg")
    }

    /// Table of the coverage of convergence measurements.
    pub fn coverage_table(&self) -> PathBuf {
        self.variants().join("coverage.md")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_assignment_need_not_have_a_starting_file() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let assignment = AssignmentFolder::new(folder.path());
        assert_eq!(assignment.starter().expect("it may be missing"), "");
        std::fs::write(assignment.starter_file(), "// TASK").expect("it can be written");
        assert_eq!(assignment.starter().expect("it can be read"), "// TASK");
    }
}
