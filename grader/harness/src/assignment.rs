//! The command-line option that selects an assignment.

use verdict::error::Result;
use verdict::rubric::Rubric;

use crate::workspace::Workspace;

/// `--assignment`.
#[derive(clap::Args)]
pub struct Assignment {
    /// Name of a folder in assignments/
    #[arg(long = "assignment", value_name = "ASSIGNMENT", default_value = "05-nee-mis")]
    pub name: String,
}

impl Assignment {
    /// Reads the rubric of the assignment.
    ///
    /// # Errors
    /// If it cannot be read, or is wrong.
    pub fn rubric(&self, workspace: &Workspace) -> Result<Rubric> {
        workspace.assignment(&self.name).rubric()
    }
}
