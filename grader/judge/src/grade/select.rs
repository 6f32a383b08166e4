//! Selecting the checks of a grade.

use verdict::error::{Error, Result};
use verdict::rubric::{CheckSpec, Rubric, Task};

/// Checks with their tasks, in the order of the rubric.
pub(super) type Selected<'a> = Vec<(&'a Task, &'a CheckSpec)>;

/// The checks that `--only` selects, in the order of the rubric; all if it is empty.
///
/// # Errors
/// If it selects none.
pub(super) fn select<'a>(rubric: &'a Rubric, only: &[String]) -> Result<Selected<'a>> {
    let names = |task: &Task, spec: &CheckSpec| {
        [
            spec.id().to_string(),
            spec.check.name().to_owned(),
            spec.scene.clone(),
            spec.technique.to_string(),
            task.id.clone(),
        ]
    };
    let selected: Selected<'a> = rubric
        .checks()
        .filter(|(task, spec)| only.is_empty() || names(task, spec).iter().any(|name| only.contains(name)))
        .collect();
    if selected.is_empty() {
        let all: Vec<String> = rubric.checks().map(|(_, spec)| spec.id().to_string()).collect();
        return Err(Error::Input(format!(
            "--only: no such check, kind, scene, technique or task; the checks are\n  {}",
            all.join("\n  ")
        )));
    }
    Ok(selected)
}
