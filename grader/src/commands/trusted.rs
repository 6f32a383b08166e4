//! The solution, for commands that are nothing without it.

use std::sync::Arc;

use crate::build::{Framework, HandInProgram};
use crate::error::{Error, Result};
use crate::reference::Oracle;
use crate::workspace::Workspace;

/// Compiles the solution.
pub(super) fn solution(workspace: &Workspace) -> Result<Arc<HandInProgram>> {
    Oracle::of(workspace, &Framework::build(workspace)?)?
        .ok_or_else(|| Error::file(&workspace.solution_file(), "this checkout does not have the solution"))?
        .program()
}
