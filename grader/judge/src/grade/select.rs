//! Which checks of a rubric a grade runs.

use verdict::error::{Error, Result};
use verdict::rubric::{CheckSpec, Rubric, Task};

/// Checks with the tasks that they belong to, in the order of the rubric.
pub(super) type Selected<'a> = Vec<(&'a Task, &'a CheckSpec)>;

/// The checks that `--only` names, in the order of the rubric.
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
            "--only: no such check, scene or task; there are\n  {}",
            all.join("\n  ")
        )));
    }
    Ok(selected)
}
