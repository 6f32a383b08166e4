//! Selecting the checks of a grade.

use verdict::error::{Error, Result};
use verdict::rubric::{CheckSpec, Rubric, Task};

/// Checks with their tasks, in the order of the rubric.
pub(super) type Selected<'a> = Vec<(&'a Task, &'a CheckSpec)>;

/// The checks that `--only` selects, in the order of the rubric; all if it is empty. `1.2` selects the tasks 1.2a and
/// 1.2b.
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
    let is_in = |task: &Task| only.iter().any(|name| is_part_of(&task.id, name));
    let selected: Selected<'a> = rubric
        .checks()
        .filter(|(task, spec)| {
            only.is_empty() || is_in(task) || names(task, spec).iter().any(|name| only.contains(name))
        })
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

/// True if a task is a lettered part of a number of the sheet: 1.2a of 1.2, but 1.20 is not.
fn is_part_of(task: &str, number: &str) -> bool {
    let ends_in_digit = number.ends_with(|last: char| last.is_ascii_digit());
    let part = task.strip_prefix(number).unwrap_or_default();
    ends_in_digit && !part.is_empty() && part.chars().all(|letter| letter.is_ascii_lowercase())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_of_the_sheet_means_all_of_its_parts() {
        assert!(is_part_of("5.1a", "5.1") && is_part_of("5.1b", "5.1"));
        for (task, number) in
            [("5.10", "5.1"), ("5.2a", "5.1"), ("5.1a", "5.1a"), ("5.1a", ""), ("5.1a", "5.")]
        {
            assert!(!is_part_of(task, number), "{task} {number}");
        }
    }
}
