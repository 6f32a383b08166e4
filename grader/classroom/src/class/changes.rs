//! Differences between the results of two runs.

use std::collections::BTreeSet;
use std::path::Path;

use super::Class;
use super::record::{Record, ResultDir};
use present::words;

/// How much of a change is described.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Detail {
    /// Points of tasks.
    Points,
    /// Points of tasks, and each check whose verdict has changed.
    Checks,
}

/// Describes what has changed in a score; `None` if nothing has.
pub(super) fn change(key: &str, before: &Record, after: &Record, detail: Detail) -> Option<String> {
    let mut parts: Vec<String> = after
        .tasks
        .iter()
        .filter_map(|(task, points)| {
            let old = before.tasks.get(task).unwrap_or(&None);
            (old != points).then(|| format!("{task} {} → {}", show(*old), show(*points)))
        })
        .collect();
    let code =
        |record: &Record| record.reason.as_ref().map_or_else(String::new, |reason| reason.code.clone());
    if code(before) != code(after) {
        parts.push(format!("reason {:?} → {:?}", code(before), code(after)));
    }
    let checks = if detail == Detail::Checks { checks(before, after) } else { Vec::new() };
    if parts.is_empty() && !checks.is_empty() {
        parts.push("the same points".to_owned());
    }
    let checks: String = checks.iter().map(|check| format!("\n    {check}")).collect();
    (!parts.is_empty()).then(|| format!("{key}: {}{checks}", parts.join(", ")))
}

/// Checks whose verdict has changed.
fn checks(before: &Record, after: &Record) -> Vec<String> {
    let names: BTreeSet<&String> = before.checks.keys().chain(after.checks.keys()).collect();
    let verdict = |record: &Record, name: &String| {
        record
            .checks
            .get(name)
            .map_or_else(|| "not in the rubric".to_owned(), |it| words::verdict(it).to_owned())
    };
    let lines = names.into_iter().map(|name| (name, verdict(before, name), verdict(after, name)));
    lines
        .filter(|(_, old, new)| old != new)
        .map(|(name, old, new)| format!("{name}: {old} → {new}"))
        .collect()
}

/// Describes the loss of a submission that an earlier run has graded.
pub(super) fn vanished(key: &str, before: &Record) -> String {
    format!(
        "{key}: {} → nothing was handed in; the earlier result is still in submissions/{key}",
        before.earned
    )
}

/// Earlier results of people who are not in the class any more.
pub(super) fn vanished_members(out: &Path, class: &Class) -> Vec<String> {
    let folders = std::fs::read_dir(out.join("submissions")).into_iter().flatten().flatten();
    let keys = folders.map(|folder| folder.file_name().to_string_lossy().into_owned());
    let gone = keys.filter(|key| !class.keys.contains(key));
    let describe = |key: String| {
        let before = ResultDir::new(out, &key).record_alone()?;
        let earned = before.earned;
        Some(format!("{key}: {earned} → not in the class; the earlier result is still in submissions/{key}"))
    };
    gone.filter_map(describe).collect()
}

fn show(points: Option<f64>) -> String {
    points.map_or_else(|| "–".to_owned(), |points| points.to_string())
}
