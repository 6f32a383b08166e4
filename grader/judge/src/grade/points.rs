//! From verdicts to points.

use super::select::Selected;
use crate::plan;
use verdict::report::{CheckResult, LeftOut, TaskResult, Verdict};
use verdict::rubric::{CheckSpec, Rubric, Task};

/// The points of one task.
pub(super) fn mark(
    task: &Task,
    selected: &Selected<'_>,
    results: &[CheckResult],
    left_out: &[LeftOut],
    nothing_ran: Option<&str>,
) -> TaskResult {
    let ids: Vec<String> = task.checks.iter().map(CheckSpec::id).collect();
    let mut result = TaskResult {
        id: task.id.clone(),
        title: task.title.clone(),
        points: None,
        max: task.points,
        elsewhere: 0.0,
        checks: ids,
        reason: String::new(),
    };
    if task.manual {
        result.reason = "marked by a person".to_owned();
        return result;
    }
    if let Some(why) = nothing_ran {
        result.points = Some(0.0);
        result.reason = why.to_owned();
        return result;
    }
    let was_selected =
        |spec: &CheckSpec| selected.iter().any(|(owner, other)| owner.id == task.id && *other == spec);
    if !task.checks.iter().all(was_selected) {
        result.reason = "not all of its checks were run".to_owned();
        return result;
    }
    let (mut earned, mut total, mut elsewhere) = (0.0, 0.0, 0.0);
    let mut missing_evidence = None;
    let mut missing = Vec::new();
    for spec in &task.checks {
        let id = spec.id();
        if left_out.iter().any(|left_out| left_out.check == id) {
            // A check that means nothing here is worth nothing; one that only staff can run keeps its worth.
            if plan::needs_staff(spec) {
                total += spec.weight;
                elsewhere += spec.weight;
            }
            continue;
        }
        total += spec.weight;
        let passed = results
            .iter()
            .any(|check| check.id == id && check.task == task.id && check.verdict == Verdict::Pass);
        if passed {
            earned += spec.weight;
        } else {
            missing.push(id.clone());
            if spec.evidence {
                missing_evidence.get_or_insert(id);
            }
        }
    }
    // Half points are the finest that a tutor would give.
    let points_of = |weight: f64| {
        let share = if total > 0.0 { weight / total } else { 0.0 };
        (task.points * share * 2.0).round() / 2.0
    };
    result.points = Some(points_of(earned));
    if elsewhere > 0.0 {
        result.elsewhere = task.points - points_of(total - elsewhere);
    }
    if let Some(id) = missing_evidence {
        result.points = Some(0.0);
        result.reason = format!("no points without {id}");
    } else if !missing.is_empty() {
        result.reason = missing.join(", ");
    }
    result
}

/// Takes the points of tasks that rest on other tasks' evidence where that is missing.
pub(super) fn require(
    rubric: &Rubric,
    mut tasks: Vec<TaskResult>,
    results: &[CheckResult],
) -> Vec<TaskResult> {
    for (task, result) in rubric.tasks.iter().zip(&mut tasks) {
        let lacks = |other: &&String| missing_evidence(other, results).is_some();
        if let (Some(points), Some(required)) = (result.points, task.requires.iter().find(lacks))
            && points > 0.0
        {
            result.points = Some(0.0);
            result.reason = format!("no points without {required}");
        }
    }
    tasks
}

/// The check that has already cost a task all of its points, if one has: evidence for it, or for a task that it
/// requires.
pub(super) fn lost_to(task: &Task, results: &[CheckResult]) -> Option<String> {
    let all = std::iter::once(&task.id).chain(&task.requires);
    all.filter_map(|task| missing_evidence(task, results)).next().map(str::to_owned)
}

/// Evidence for a task that was looked for and not found.
fn missing_evidence<'a>(task: &str, results: &'a [CheckResult]) -> Option<&'a str> {
    let missing =
        |check: &&CheckResult| check.task == task && check.evidence && check.verdict != Verdict::Pass;
    results.iter().find(missing).map(|check| check.id.as_str())
}

#[cfg(test)]
mod tests {
    use super::*;
    use verdict::sample;

    #[test]
    fn missing_evidence_costs_a_task_and_those_that_require_it_everything() {
        let yaml = "
assignment: a
title: a
tasks:
  - { id: one, title: one, points: 1, checks: [{ check: mis-weights, technique: mis, max_bounces: 3, evidence: true }] }
  - { id: two, title: two, points: 1, requires: [one], checks: [{ check: light-pick, technique: mis, max_bounces: 1, evidence: true }] }
  - { id: three, title: three, points: 1, checks: [{ check: light-pick, technique: nee, max_bounces: 1, evidence: true }] }
";
        let folder = tempfile::tempdir().expect("a temporary folder");
        let file = folder.path().join("rubric.yml");
        std::fs::write(&file, yaml).expect("it can be written");
        let rubric = Rubric::load(&file).expect("it is a rubric");
        let result = |verdict| {
            let id = "mis-weights/scripted/mis/3".to_owned();
            let sample = sample::report("").checks[0].clone();
            CheckResult { id, task: "one".to_owned(), evidence: true, verdict, ..sample }
        };
        let lost = |verdict| {
            rubric.tasks.iter().map(|task| lost_to(task, &[result(verdict)]).is_some()).collect::<Vec<_>>()
        };
        assert_eq!(lost(Verdict::Fail), [true, true, false]);
        assert_eq!(lost(Verdict::Inconclusive), [true, true, false]);
        assert_eq!(lost(Verdict::Pass), [false; 3]);
    }
}
