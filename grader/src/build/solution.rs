//! The solution as a program: staff's own code, built like any hand-in.

use super::{Framework, HandInProgram, compile};
use crate::error::{Error, Result};
use crate::sandbox::Limits;
use crate::submission::Submission;
use crate::workspace::Workspace;

/// Compiles the solution; `None` in a checkout that does not have it.
///
/// # Errors
/// If it does not compile.
pub fn solution(workspace: &Workspace, framework: &Framework) -> Result<Option<HandInProgram>> {
    let path = workspace.solution_file();
    if !path.is_file() {
        return Ok(None);
    }
    let source = Submission::read(&path)?.source;
    compile(framework, &source, &Limits::default())?
        .map(Some)
        .map_err(|failure| Error::file(&path, format!("does not compile:\n{}", failure.messages)))
}
