//! What verdicts depend on besides the submission.

use harness::tree_hash::hash_judging;
use harness::workspace::Workspace;
use judge::grade::{Grader, Options};
use judge::reference::Oracle;
use verdict::error::Result;
use verdict::report::Provenance;

/// Hash of everything that verdicts depend on except the submission: framework, judging crates, solution, rubric,
/// scenes, references and seed. The late policy is not part of it.
pub(super) fn hash_of_inputs(
    workspace: &Workspace,
    grader: &Grader,
    options: &Options,
) -> Result<blake3::Hash> {
    let mut hasher = blake3::Hasher::new();
    // The rubric's tasks are named below: its policy changes no verdict.
    let provenance = Provenance { rubric: String::new(), ..grader.provenance().clone() };
    hasher.update(format!("{provenance:?}").as_bytes());
    hasher.update(format!("{:?} {:?}", grader.rubric().tasks, options.only).as_bytes());
    hasher.update(format!("{:?}", grader.oracle().map(Oracle::hash)).as_bytes());
    hash_judging(workspace, &mut hasher)?;
    Ok(hasher.finalize())
}
