//! The solution as a program: staff's own code, built like any hand-in.

use crate::build::{Framework, HandInProgram, compile};
use crate::error::{Error, Result};
use crate::sandbox::Limits;
use crate::submission::Submission;
use crate::workspace::Workspace;

/// Compiles the solution.
pub(super) fn solution(workspace: &Workspace) -> Result<HandInProgram> {
    let solution = Submission::read(&workspace.solution_file())?;
    compile(&Framework::build(workspace)?, &solution.source, &Limits::default())?
        .map_err(|failure| Error::Harness(format!("the solution does not compile:\n{}", failure.messages)))
}
