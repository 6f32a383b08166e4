//! Computing points from verdicts.

use verdict::check::{CheckId, CheckResult, Verdict};
use verdict::report::{SkippedCheck, TaskResult, TaskState};
use verdict::rubric::{CheckSpec, Rubric, Task};

use super::select::Selected;
use crate::plan;

/// The points of one task. `nothing_ran` is the reason if no check of the grade was run.
pub(super) fn score(
    task: &Task,
    selected: &Selected<'_>,
    results: &[CheckResult],
    skipped: &[SkippedCheck],
    nothing_ran: Option<TaskState>,
) -> TaskResult {
    let result = |points: Option<f64>, state: TaskState| TaskResult {
        id: task.id.clone(),
        title: task.title.clone(),
        points,
        max: task.points,
        staff_only: 0.0,
        checks: task.checks.iter().map(CheckSpec::id).collect(),
        steps: task.steps(),
        state,
    };
    if task.manual {
        return result(None, TaskState::ByHand { comment: None });
    }
    if let Some(state) = nothing_ran {
        return result(Some(0.0), state);
    }
    let was_selected =
        |spec: &CheckSpec| selected.iter().any(|(owner, other)| owner.id == task.id && *other == spec);
    if !task.checks.iter().all(was_selected) {
        return result(None, TaskState::Partial);
    }
    let (mut earned, mut total, mut staff_only) = (0.0, 0.0, 0.0);
    // Largest weight of a check that failed by a slight error.
    let mut slight: f64 = 0.0;
    let mut missing = Vec::new();
    for spec in &task.checks {
        let id = spec.id();
        if skipped.iter().any(|skipped| skipped.check.as_ref() == Some(&id)) {
            // A check that does not apply is worth nothing. One that only staff can run keeps its points open.
            if plan::needs_staff(spec) {
                total += spec.weight;
                staff_only += spec.weight;
            }
            continue;
        }
        total += spec.weight;
        let is_it = |check: &&CheckResult| check.id == id && check.task == task.id;
        match results.iter().find(is_it) {
            Some(check) if check.verdict == Verdict::Pass => earned += spec.weight,
            Some(check) if check.is_slightly_wrong() => {
                earned += spec.weight;
                slight = slight.max(spec.weight);
                missing.push((id, false));
            }
            _ => missing.push((id, spec.required)),
        }
    }
    // How many checks detect a slight error is chance, so that it costs the share of one.
    earned -= slight;
    // Points are rounded to halves, as a tutor would give them.
    let points_of = |weight: f64| {
        let share = if total > 0.0 { weight / total } else { 0.0 };
        (task.points * share * 2.0).round() / 2.0
    };
    let required = missing.iter().find(|(_, required)| *required).map(|(id, _)| id.clone());
    let mut result = match required {
        Some(id) => result(Some(0.0), TaskState::RequiredCheckMissing(Some(id))),
        None => {
            let missing = missing.into_iter().map(|(id, _)| id).collect();
            result(Some(points_of(earned)), TaskState::Graded { missing })
        }
    };
    if staff_only > 0.0 {
        result.staff_only = task.points - points_of(total - staff_only);
    }
    result
}

/// Removes the points of tasks that require another task of which a required check did not pass.
pub(super) fn require(
    rubric: &Rubric,
    mut tasks: Vec<TaskResult>,
    results: &[CheckResult],
) -> Vec<TaskResult> {
    for (task, result) in rubric.tasks.iter().zip(&mut tasks) {
        let lacks = |other: &&String| missing_required(other, results).is_some();
        if let (Some(points), Some(required)) = (result.points, task.requires.iter().find(lacks))
            && points > 0.0
        {
            result.points = Some(0.0);
            result.state = TaskState::RequiredTaskMissing(required.clone());
        }
    }
    tasks
}

/// The required check that has already cost a task all of its points: its own, or one of a task that it requires.
/// `None` if there is none.
pub(super) fn lost_to<'a>(task: &Task, results: &'a [CheckResult]) -> Option<&'a CheckId> {
    let all = std::iter::once(&task.id).chain(&task.requires);
    all.filter_map(|task| missing_required(task, results)).next()
}

/// The first required check of a task that was run and did not pass, unless it is only slightly wrong.
fn missing_required<'a>(task: &str, results: &'a [CheckResult]) -> Option<&'a CheckId> {
    let missing = |check: &&CheckResult| {
        check.task == task && check.required && check.verdict != Verdict::Pass && !check.is_slightly_wrong()
    };
    results.iter().find(missing).map(|check| &check.id)
}

#[cfg(test)]
mod tests {
    use super::*;
    use verdict::check::{Effect, Evidence, MeanTest, Reason, RegionId, RegionKind};
    use verdict::sample;

    /// A check of task "one" that failed by a relative error.
    fn biased(id: &str, required: bool, relative: f64) -> CheckResult {
        let test = MeanTest {
            region: RegionId { kind: RegionKind::Weighted, pixels: None },
            effect: Some(relative),
            interval: Some([relative - 0.002, relative + 0.002]),
            detectable: None,
            tolerance: 0.02,
            whole: Some(Effect { relative, margin: 0.002 }),
            z: Vec::new(),
        };
        CheckResult {
            id: id.parse().expect("it is a name"),
            task: "one".to_owned(),
            required,
            verdict: Verdict::Fail,
            reason: Reason::Bias,
            evidence: Some(Evidence::MeanBias(test)),
            ..sample::report("").checks[0].clone()
        }
    }

    /// A rubric of these tasks.
    fn rubric_of(tasks: &str) -> Rubric {
        let head = "
assignment: a
title: a
submission: { file: a/x.rs, contract: path-tracer }
techniques: [bsdf, nee, mis]
reference_technique: mis
tasks:
";
        let folder = tempfile::tempdir().expect("a temporary folder");
        let file = folder.path().join("rubric.yml");
        std::fs::write(&file, format!("{head}{tasks}")).expect("it can be written");
        Rubric::load(&file).expect("it is a rubric")
    }

    #[test]
    fn a_slight_error_costs_the_share_of_one_check_however_many_detect_it() {
        let rubric = rubric_of(
            "
  - id: one
    title: one
    points: 20
    checks:
      - { check: mean-bias, scene: a, technique: nee, max_bounces: 1, required: true }
      - { check: mean-bias, scene: b, technique: nee, max_bounces: 1 }
      - { check: mean-bias, scene: c, technique: nee, max_bounces: 1 }
      - { check: mean-bias, scene: d, technique: nee, max_bounces: 1 }
",
        );
        let task = &rubric.tasks[0];
        let selected: Selected<'_> = task.checks.iter().map(|spec| (task, spec)).collect();
        let points = |errors: [f64; 4]| {
            let check = |(spec, error): (&CheckSpec, f64)| {
                let id = spec.id().to_string();
                let verdict = if error == 0.0 { Verdict::Pass } else { Verdict::Fail };
                CheckResult { verdict, ..biased(&id, spec.required, error) }
            };
            let results: Vec<CheckResult> = task.checks.iter().zip(errors).map(check).collect();
            score(task, &selected, &results, &[], None).points
        };
        assert_eq!(points([0.0; 4]), Some(20.0));
        assert_eq!(points([0.0, 0.01, 0.0, 0.0]), Some(15.0));
        assert_eq!(points([-0.01, -0.01, -0.01, -0.01]), Some(15.0));
        assert_eq!(points([0.0, 0.01, 0.5, 0.0]), Some(10.0));
        assert_eq!(points([0.03, 0.0, 0.0, 0.0]), Some(0.0));
    }

    #[test]
    fn a_slight_error_of_a_required_check_does_not_cost_the_task() {
        let is_lost =
            |relative| missing_required("one", &[biased("mean-bias/a/nee/1", true, relative)]).is_some();
        assert!(!is_lost(-0.01) && is_lost(-0.03) && is_lost(0.5));
    }

    #[test]
    fn a_failed_required_check_costs_its_task_and_dependent_tasks_all_points() {
        let rubric = rubric_of(
            "
  - { id: one, title: one, points: 1, checks: [{ check: mis-weights, technique: mis, max_bounces: 3, required: true }] }
  - { id: two, title: two, points: 1, requires: [one], checks: [{ check: light-pick, technique: mis, max_bounces: 1, required: true }] }
  - { id: three, title: three, points: 1, checks: [{ check: light-pick, technique: nee, max_bounces: 1, required: true }] }
",
        );
        let result = |verdict| {
            let id = "mis-weights/scripted/mis/3".parse().expect("it is a name");
            let sample = sample::report("").checks[0].clone();
            CheckResult { id, task: "one".to_owned(), required: true, verdict, ..sample }
        };
        let lost = |verdict: Verdict| {
            let results = [result(verdict)];
            rubric.tasks.iter().map(|task| lost_to(task, &results).is_some()).collect::<Vec<_>>()
        };
        assert_eq!(lost(Verdict::Fail), [true, true, false]);
        assert_eq!(lost(Verdict::Inconclusive), [true, true, false]);
        assert_eq!(lost(Verdict::Pass), [false; 3]);
    }
}
