//! The solution, for commands that are nothing without it.

use crate::build::{self, Framework, HandInProgram};
use crate::error::{Error, Result};
use crate::workspace::Workspace;

/// Compiles the solution.
pub(super) fn solution(workspace: &Workspace) -> Result<HandInProgram> {
    build::solution(workspace, &Framework::build(workspace)?)?
        .ok_or_else(|| Error::file(&workspace.solution_file(), "this checkout does not have the solution"))
}
