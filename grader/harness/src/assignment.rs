//! Which assignment a command is about.

use verdict::error::Result;
use verdict::rubric::Rubric;

use crate::workspace::Workspace;

/// The option that names it.
#[derive(clap::Args)]
pub struct Assignment {
    /// The assignment: a folder below assignments/
    #[arg(long = "assignment", value_name = "ASSIGNMENT", default_value = "05-nee-mis")]
    pub name: String,
}

impl Assignment {
    /// Its rubric.
    pub fn rubric(&self, workspace: &Workspace) -> Result<Rubric> {
        Rubric::load(&workspace.assignment(&self.name).join("rubric.yml"))
    }
}
