//! Which assignment a command is about.

use crate::error::Result;
use crate::rubric::Rubric;
use crate::workspace::Workspace;

/// The option that names it.
#[derive(clap::Args)]
pub(super) struct Assignment {
    /// The assignment: a folder below assignments/
    #[arg(long = "assignment", value_name = "ASSIGNMENT", default_value = "05-nee-mis")]
    pub(super) name: String,
}

impl Assignment {
    /// Its rubric.
    pub(super) fn rubric(&self, workspace: &Workspace) -> Result<Rubric> {
        Rubric::load(&workspace.assignment(&self.name).join("rubric.yml"))
    }
}
