//! Where a student stands: the first task that is not finished, its first step that is not done, and the one check to
//! look at.

use arty::integrator::Technique;

use crate::check::{CheckId, CheckResult, Reason, Verdict};
use crate::report::{Cause, Diagnosis, Report, TaskResult};

/// What to work on next.
#[derive(Clone, Debug)]
pub struct Next<'a> {
    /// The first task with a check that costs it points.
    pub task: &'a TaskResult,
    /// Its first step that is not done; `None` if the task has no steps, or its check belongs to none.
    pub step: Option<NextStep<'a>>,
    /// The check to look at.
    pub check: &'a CheckResult,
    /// The most likely cause that concerns this check; `None` if none is known.
    pub cause: Option<&'a Diagnosis>,
}

/// A step of a task.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NextStep<'a> {
    /// Its number, counted from 1.
    pub number: usize,
    /// Number of steps of the task.
    pub of: usize,
    /// Title of the step, as in the rubric.
    pub title: &'a str,
}

impl Report {
    /// What to work on next; `None` if every check passed, or nothing was run.
    pub fn next(&self) -> Option<Next<'_>> {
        let task = self.tasks.iter().find(|task| !self.lacking(&task.id).is_empty())?;
        let lacking = self.lacking(&task.id);
        // What a required check has cut short says nothing yet.
        let is_telling = |check: &CheckResult| match check.verdict {
            Verdict::Fail => true,
            Verdict::Inconclusive => !check.short_look,
            _ => false,
        };
        let telling: Vec<&CheckResult> = lacking.iter().copied().filter(|check| is_telling(check)).collect();
        let candidates = if telling.is_empty() { lacking } else { telling };
        let step_of = |id: &CheckId| task.steps.iter().position(|step| step.checks.contains(id));
        // A check outside of all steps comes last. Sorting is stable: failed ones stay first in a step.
        let check = candidates.into_iter().min_by_key(|check| step_of(&check.id).unwrap_or(usize::MAX))?;
        let step = step_of(&check.id).map(|index| NextStep {
            number: index + 1,
            of: task.steps.len(),
            title: &task.steps[index].title,
        });
        Some(Next { task, step, check, cause: self.cause_of(task, check) })
    }

    /// True if all checks of a task passed that were run, and at least one was.
    pub fn is_done(&self, task: &TaskResult) -> bool {
        self.lacking(&task.id).is_empty() && task.points.is_some_and(|points| points > 0.0)
    }

    /// The most likely cause that concerns a check of a task.
    fn cause_of(&self, task: &TaskResult, check: &CheckResult) -> Option<&Diagnosis> {
        let concerns = |diagnosis: &&Diagnosis| match &diagnosis.cause {
            Cause::NothingToCompile | Cause::DoesNotCompile | Cause::NotBegun { .. } => true,
            Cause::Panics | Cause::TodoLeft => check.reason == Reason::Crash,
            Cause::DoesNotFinish { .. } => check.reason == Reason::Timeout || !check.was_run(),
            Cause::ConstantFactor { .. } => check.id.technique == Technique::Nee,
            Cause::FailedFact(fact) => check.id.technique == fact.technique,
            Cause::TechniqueNotBegun { technique, .. } => check.id.technique == *technique,
            Cause::BsdfChanged => check.id.technique == Technique::Bsdf,
            Cause::Known { .. } => {
                !matches!(check.reason, Reason::Crash | Reason::Timeout)
                    && diagnosis.seen.as_ref().is_some_and(|seen| task.checks.contains(&seen.wrong))
            }
            Cause::Unknown { .. } => false,
        };
        self.diagnosis.iter().find(concerns)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::{CheckKind, SkipReason};
    use crate::report::{Step, TaskState};
    use crate::sample;

    /// A task with checks of these kinds, each a step of its own.
    fn with(kinds: &[(CheckKind, Verdict)]) -> Report {
        let mut report = sample::report("x");
        let sample = report.checks.remove(0);
        for (kind, verdict) in kinds {
            let id = sample::id(*kind, "box");
            let check = CheckResult {
                id: id.clone(),
                required: false,
                verdict: verdict.clone(),
                short_look: *verdict == Verdict::Inconclusive,
                ..sample.clone()
            };
            report.checks.push(check);
            report.tasks[0].checks.push(id.clone());
            report.tasks[0].steps.push(Step { title: kind.name().to_owned(), checks: vec![id] });
        }
        report
    }

    #[test]
    fn the_first_step_with_a_telling_check_is_next() {
        let skipped = Verdict::Skipped { why: SkipReason::PointsLostTo(None) };
        let report = with(&[
            (CheckKind::MeanBias, Verdict::Pass),
            (CheckKind::LightPick, Verdict::Inconclusive),
            (CheckKind::ClosedForm, skipped),
            (CheckKind::RayBudget, Verdict::Fail),
            (CheckKind::Stability, Verdict::Fail),
        ]);
        let next = report.next().expect("something failed");
        assert_eq!(next.step, Some(NextStep { number: 4, of: 5, title: "ray-budget" }));
        assert_eq!(next.check.id.kind, CheckKind::RayBudget);
        // Without any other, it is the one that was cut short.
        let report =
            with(&[(CheckKind::MeanBias, Verdict::Pass), (CheckKind::LightPick, Verdict::Inconclusive)]);
        assert_eq!(report.next().map(|next| next.check.id.kind), Some(CheckKind::LightPick));
        let report = with(&[(CheckKind::MeanBias, Verdict::Pass)]);
        assert!(report.next().is_none() && report.is_done(&report.tasks[0]));
        assert!(!report.is_done(&report.tasks[1]), "a tutor grades it");
    }

    #[test]
    fn a_cause_that_was_seen_in_a_later_task_is_not_shown() {
        let mut report = with(&[(CheckKind::MeanBias, Verdict::Fail)]);
        let elsewhere = sample::id(CheckKind::MisWeights, "scripted");
        let here = report.checks[0].id.clone();
        let cause =
            |report: &Report| report.next().and_then(|next| next.cause).map(|it| it.cause.id().to_owned());
        let seen = report.diagnosis[0].seen.as_mut().expect("it was seen");
        seen.wrong = elsewhere;
        assert_eq!(cause(&report), None);
        let mut second = report.diagnosis[0].clone();
        second.seen.as_mut().expect("it was seen").wrong = here;
        report.diagnosis.push(second);
        assert_eq!(cause(&report).as_deref(), Some("x"));
        // A panic elsewhere does not hide it, and explains what itself has stopped.
        report.diagnosis.insert(0, Diagnosis { cause: Cause::Panics, confidence: 1.0, seen: None });
        assert_eq!(cause(&report).as_deref(), Some("x"));
        report.checks[0].reason = Reason::Crash;
        assert_eq!(cause(&report).as_deref(), Some("panics"));
        report.tasks[0].state = TaskState::Partial;
        assert!(report.next().is_some(), "a task of which only some checks were selected, too");
    }
}
