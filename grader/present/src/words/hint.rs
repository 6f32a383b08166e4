//! What `grader hint` says, level by level.

use verdict::next::Next;
use verdict::report::{Cause, Diagnosis, Report};

use super::{about, explanation, heading, hint, repeat_command, replay_of, seen};

/// What the check of the next step does, and what it saw.
pub fn hint_on_check(report: &Report, next: &Next<'_>) -> Vec<String> {
    let mut lines = vec![
        format!("{} {}", next.check.id, about(next.check.id.kind)),
        format!("it saw: {}", explanation(next.check)),
    ];
    let observed = next.cause.map(|diagnosis| seen(report, diagnosis)).unwrap_or_default();
    if !observed.is_empty() && observed != explanation(next.check) {
        lines.push(format!("observed: {observed}"));
    }
    lines
}

/// The likely causes that concern the task of the next step, each with its question.
pub fn hint_on_causes(report: &Report, next: &Next<'_>) -> Vec<String> {
    let is_of_task = |diagnosis: &&Diagnosis| {
        let seen = diagnosis.seen.as_ref();
        let elsewhere = seen.is_some_and(|seen| !next.task.checks.contains(&seen.wrong));
        !elsewhere && !matches!(diagnosis.cause, Cause::Unknown { .. })
    };
    let lines: Vec<String> = report
        .diagnosis
        .iter()
        .filter(is_of_task)
        .flat_map(|diagnosis| {
            let hint = Some(hint(&diagnosis.cause)).filter(|hint| !hint.is_empty());
            std::iter::once(heading(diagnosis)).chain(hint.map(|hint| format!("hint: {hint}")))
        })
        .collect();
    if lines.is_empty() {
        let alone = "No known mistake fits. Look at one path: which factor of its contribution is not what you expect?";
        return vec![alone.to_owned()];
    }
    lines
}

/// Commands that show the mistake again.
pub fn hint_on_paths(report: &Report, next: &Next<'_>) -> Vec<String> {
    let rerun = format!("rerun: {}", repeat_command(report, &next.check.id));
    let replay = replay_of(next.check, &report.submission.path).map(|replay| format!("replay: {replay}"));
    std::iter::once(rerun).chain(replay).collect()
}
