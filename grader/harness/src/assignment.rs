//! An assignment, and the command-line option that selects one.

use std::path::{Path, PathBuf};

use serde::Deserialize;
use verdict::error::{Error, Result};
use verdict::rubric::Rubric;

use crate::assignment_folder::AssignmentFolder;
use crate::build::Framework;
use crate::workspace::Workspace;

/// An assignment of a checkout: its folder and its rubric.
#[derive(Clone, Debug)]
pub struct Assignment {
    /// Name or folder of the assignment, as given on the command line.
    pub name: String,
    /// The paths of its files.
    pub folder: AssignmentFolder,
    /// Tasks, points, checks, and what students hand in.
    pub rubric: Rubric,
    /// Top folder of the checkout.
    root: PathBuf,
}

impl Assignment {
    /// The assignment with this name, or in this folder.
    ///
    /// # Errors
    /// If its rubric cannot be read, or is wrong.
    pub fn open(workspace: &Workspace, name: &str) -> Result<Self> {
        let folder = workspace.assignment(name);
        let rubric = folder.rubric()?;
        Ok(Self { name: name.to_owned(), folder, rubric, root: workspace.root().to_owned() })
    }

    /// The file that students work in, in a handout of this assignment.
    pub fn student_file(&self) -> PathBuf {
        self.root.join(&self.rubric.submission.path)
    }

    /// The solution's version of the student's file. Handouts do not contain it.
    pub fn solution_file(&self) -> PathBuf {
        match &self.rubric.submission.solution {
            Some(path) => self.root.join(path),
            None => self.folder.path().join("solution.rs"),
        }
    }

    /// True if the checkout has the solution.
    pub fn has_solution(&self) -> bool {
        self.solution_file().is_file()
    }

    /// Text of the solution.
    ///
    /// # Errors
    /// If it cannot be read.
    pub fn solution(&self) -> Result<String> {
        let path = self.solution_file();
        let text = std::fs::read_to_string(&path).map_err(|error| Error::file(&path, error))?;
        Ok(text.replace("\r\n", "\n"))
    }

    /// The framework that its submissions are linked against.
    ///
    /// # Errors
    /// If it does not build, or if there is no compiler.
    pub fn framework(&self, workspace: &Workspace) -> Result<Framework> {
        Framework::build(workspace, &self.rubric.submission)
    }
}

/// `--assignment`.
#[derive(Clone, Debug, Default, clap::Args)]
pub struct AssignmentOption {
    /// Name of a folder in assignments/ [default: the one you are in, the only one, or that of assignments/default.yml]
    #[arg(long)]
    assignment: Option<String>,
}

impl AssignmentOption {
    /// Reads the assignment that is meant.
    ///
    /// # Errors
    /// If none is named and there are several, or its rubric is wrong.
    pub fn open(&self, workspace: &Workspace) -> Result<Assignment> {
        match &self.assignment {
            Some(name) => Assignment::open(workspace, name),
            None => Assignment::open(
                workspace,
                &default_name(workspace, std::env::current_dir().ok().as_deref())?,
            ),
        }
    }
}

/// Contents of `assignments/default.yml`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Setting {
    assignment: String,
}

/// Name of the assignment that is meant where none is named: the one that `current` is in, the only one, or the one that
/// `assignments/default.yml` names.
///
/// # Errors
/// If this leaves several, or none.
pub fn default_name(workspace: &Workspace, current: Option<&Path>) -> Result<String> {
    let all = workspace.assignments()?;
    let top = workspace.assignments_folder();
    let inside = current.and_then(|folder| folder.strip_prefix(&top).ok()?.iter().next()?.to_str());
    if let Some(name) = inside.filter(|&name| all.iter().any(|other| other == name)) {
        return Ok(name.to_owned());
    }
    if let [only] = all.as_slice() {
        return Ok(only.clone());
    }
    let file = top.join("default.yml");
    if file.is_file() {
        let (Setting { assignment }, _) = arty::yaml::read(&file)?;
        if all.contains(&assignment) {
            return Ok(assignment);
        }
        return Err(Error::file(
            &file,
            format!("there is no assignment `{assignment}`; there are: {}", all.join(", ")),
        ));
    }
    Err(match all.as_slice() {
        [] => Error::file(&top, "there is no assignment in it: no folder with a rubric.yml"),
        _ => Error::Input(format!(
            "there are several assignments: {}; name one with --assignment=NAME, or in {}",
            all.join(", "),
            file.display()
        )),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_assignment_is_the_one_you_are_in_or_the_only_one_or_the_one_of_the_setting() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let write = |name: &str, text: &str| {
            let path = folder.path().join(name);
            std::fs::create_dir_all(path.parent().expect("it has one")).expect("it can be made");
            std::fs::write(path, text).expect("it can be written");
        };
        write("skeleton/Cargo.toml", "");
        write("scenes/a.yml", "");
        write("assignments/notes.md", "");
        let workspace = Workspace::open(folder.path()).expect("it has skeleton/ and scenes/");
        let inside = |name: &str| default_name(&workspace, Some(&workspace.root().join(name)));
        let message = |name: &str| inside(name).expect_err(name).to_string();
        assert!(message("").contains("there is no assignment"));
        write("assignments/one/rubric.yml", "");
        assert_eq!(inside("scenes").expect("it is the only one"), "one");
        write("assignments/two/rubric.yml", "");
        assert_eq!(inside("assignments/two/figures").expect("there we are"), "two");
        assert!(message("scenes").contains("one, two; name one with --assignment"));
        write("assignments/default.yml", "assignment: two\n");
        assert_eq!(inside("scenes").expect("it is set"), "two");
        assert_eq!(inside("assignments/one").expect("there we are"), "one");
        write("assignments/default.yml", "assignment: three\n");
        assert!(message("scenes").contains("no assignment `three`"));
    }
}
