//! What to work on next, what is done, and what has changed.

use verdict::check::{CheckId, CheckResult, Verdict};
use verdict::next::Next;
use verdict::report::{Report, TaskResult, TaskState};

use super::number::count;
use super::task::task_state;

/// "Next: 1a Next event estimation, step 2 of 6: selection probability".
pub fn next_heading(next: &Next<'_>) -> String {
    let step = next
        .step
        .map_or(String::new(), |step| format!(", step {} of {}: {}", step.number, step.of, step.title));
    format!("Next: {} {}{step}", next.task.id, next.task.title)
}

/// "✓ one point light, ✓ several lights"; empty if no step of the task is done.
pub fn steps_done(report: &Report, task: &TaskResult) -> String {
    let of = |id: &CheckId| report.checks.iter().find(|check| check.task == task.id && check.id == *id);
    let done = task.steps.iter().filter(|step| {
        let mut results = step.checks.iter().filter_map(of).peekable();
        results.peek().is_some() && results.all(|check| check.verdict == Verdict::Pass)
    });
    done.map(|step| format!("✓ {}", step.title)).collect::<Vec<_>>().join(", ")
}

/// Where a student stands in a task, in a few words; empty if nothing is to be said.
pub(crate) fn standing(report: &Report, task: &TaskResult, next: Option<&Next<'_>>) -> String {
    if report.is_done(task) {
        let more = match task.staff_only {
            0.0 => String::new(),
            1.0 => "; 1 more is decided by checks that only your tutor can run".to_owned(),
            points => format!("; {points} more are decided by checks that only your tutor can run"),
        };
        return format!("✓ done{more}");
    }
    match (&task.state, next) {
        (_, Some(next)) if next.task.id == task.id => {
            next.step.map_or("next".to_owned(), |step| format!("step {} of {}", step.number, step.of))
        }
        (TaskState::RequiredTaskMissing(other), _) => format!("needs {other} first"),
        (TaskState::ByHand { .. } | TaskState::Partial, _) | (_, None) => task_state(task),
        _ => String::new(),
    }
}

/// What to do when every check passes; `None` if nothing was run.
pub fn finish(report: &Report) -> Option<String> {
    if report.checks.is_empty() {
        return None;
    }
    if report.tasks.iter().any(|task| task.state == TaskState::Partial) {
        return Some("The selected checks pass; `cargo grade` runs all of them.".to_owned());
    }
    let by_hand = |task: &&TaskResult| matches!(task.state, TaskState::ByHand { comment: None });
    let by_hand: Vec<String> =
        report.tasks.iter().filter(by_hand).map(|task| format!("{} {}", task.id, task.title)).collect();
    let next = match by_hand.as_slice() {
        [] => "Next: `cargo grader pack`.".to_owned(),
        tasks => format!("Next: {}, then `cargo grader pack --explanation=FILE`.", tasks.join(", ")),
    };
    Some(format!("Done: everything that can be graded here passes. {next}"))
}

/// What to know about printing; `None` if the source does not print.
pub fn prints(file: &str, lines: &[usize]) -> Option<String> {
    let (first, more) = (lines.first()?, lines.len() - 1);
    let more = if more == 0 { String::new() } else { format!(" and {more} more") };
    Some(format!(
        "note: your program prints ({file}:{first}{more}): a grade discards it; `cargo grader replay` and `cargo arty` \
         show it"
    ))
}

/// What has changed between two grades; `None` if nothing has.
pub fn changes(before: &Report, after: &Report) -> Option<String> {
    let ended = |report: &Report, check: &CheckResult, verdict: &Verdict| {
        let same = |other: &&CheckResult| other.task == check.task && other.id == check.id;
        report.checks.iter().find(same).is_some_and(|other| other.verdict == *verdict)
    };
    let became = |verdict: &Verdict, from: &dyn Fn(&CheckResult) -> bool| -> Vec<String> {
        let new = |check: &&CheckResult| check.verdict == *verdict && from(check);
        after.checks.iter().filter(new).map(|check| check.id.to_string()).collect()
    };
    let had_result = |check: &CheckResult| before.checks.iter().any(|other| other.id == check.id);
    let passes = became(&Verdict::Pass, &|check| had_result(check) && !ended(before, check, &Verdict::Pass));
    let fails = became(&Verdict::Fail, &|check| had_result(check) && !ended(before, check, &Verdict::Fail));
    let points = after.points.earned - before.points.earned;
    let mut lines = Vec::new();
    if points != 0.0 {
        lines.push(format!("{points:+} points"));
    }
    for (what, checks) in [("now passes", passes), ("now fails", fails)] {
        match checks.as_slice() {
            [] => {}
            [one] => lines.push(format!("{what}: {one}")),
            [one, rest @ ..] => lines.push(format!("{what}: {one} and {}", count(rest.len(), "other check"))),
        }
    }
    (!lines.is_empty()).then(|| format!("since the last save: {}", lines.join("; ")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use verdict::sample;

    #[test]
    fn changes_are_counted_from_the_last_grade() {
        let before = sample::report("x");
        assert_eq!(changes(&before, &before), None);
        let mut after = before.clone();
        after.checks[0].verdict = Verdict::Pass;
        after.points.earned = 15.0;
        let better = "since the last save: +2.5 points; now passes: mean-bias/x/nee/8";
        assert_eq!(changes(&before, &after).as_deref(), Some(better));
        let worse = "since the last save: -2.5 points; now fails: mean-bias/x/nee/8";
        assert_eq!(changes(&after, &before).as_deref(), Some(worse));
    }

    #[test]
    fn printing_is_said_with_its_lines() {
        assert_eq!(prints("a.rs", &[]), None);
        let said = prints("a.rs", &[7, 9]).expect("it prints");
        assert!(said.contains("a.rs:7 and 1 more"), "{said}");
    }
}
