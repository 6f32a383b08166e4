//! Running the checks of a grade in parallel.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use arty::integrator::Technique;

use super::points::lost_to;
use super::select::Selected;
use crate::checks::{GradeContext, out_of_time, skipped};
use verdict::check::{CheckResult, Reason};
use verdict::error::{Error, Result};
use verdict::rubric::{CheckSpec, Task};

/// Maximum number of checks in parallel. Each has all threads of the grade, so that the last one leaves no core idle;
/// more would only compete with each other.
const MAX_CONCURRENT: usize = 4;

/// Runs checks and returns their results in the given order. `on_check` is called after each check.
///
/// Required checks run first. If one has cost a task all of its points, the other checks of the task cannot affect the
/// points: they get short looks, which show most mistakes, and checks that test generalisation are skipped. Which tasks
/// these are depends only on verdicts, not on the number of checks in parallel.
///
/// # Errors
/// If the grader itself fails.
pub(super) fn run(
    context: &GradeContext<'_>,
    selected: &Selected<'_>,
    on_check: impl FnMut(&CheckResult) + Send,
) -> Result<Vec<CheckResult>> {
    let on_check = Mutex::new(on_check);
    let (timeouts, shortened) = (TimeoutTracker::default(), context.with_short_looks());
    let run_one = |(number, (task, spec)): (usize, (&Task, &CheckSpec)), required: &[CheckResult]| {
        let result = match lost_to(task, required) {
            _ if timeouts.give_up(spec.technique) => out_of_time(task, spec),
            None => context.run(task, spec)?,
            Some(lost_to) if spec.check.tests_generalisation() => skipped(task, spec, lost_to),
            Some(_) => CheckResult { short_look: true, ..shortened.run(task, spec)? },
        };
        timeouts.record(&result);
        on_check.lock().unwrap_or_else(PoisonError::into_inner)(&result);
        Ok((number, result))
    };
    let numbered = selected.iter().copied().enumerate();
    let (first, others): (Vec<_>, Vec<_>) = numbered.partition(|(_, (_, spec))| spec.required);
    let mut results = in_parallel(context.threads, &first, |&check| run_one(check, &[]))?;
    let required: Vec<CheckResult> = results.iter().map(|(_, result)| result.clone()).collect();
    results.extend(in_parallel(context.threads, &others, |&check| run_one(check, &required))?);
    results.sort_by_key(|(number, _)| *number);
    Ok(results.into_iter().map(|(_, result)| result).collect())
}

/// Maps `one` over `things` on several threads, in no particular order, and stops at the first error.
fn in_parallel<T: Sync, R: Send>(
    threads: usize,
    things: &[T],
    one: impl Fn(&T) -> Result<R> + Sync,
) -> Result<Vec<R>> {
    let next = AtomicUsize::new(0);
    let (results, error): (Mutex<Vec<R>>, Mutex<Option<Error>>) = Default::default();
    let work = || {
        while let Some(thing) = things.get(next.fetch_add(1, Ordering::Relaxed)) {
            match one(thing) {
                Ok(result) => results.lock().unwrap_or_else(PoisonError::into_inner).push(result),
                Err(first) => {
                    error.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(first);
                    next.store(things.len(), Ordering::Relaxed);
                }
            }
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..threads.clamp(1, MAX_CONCURRENT).min(things.len()) {
            scope.spawn(work);
        }
    });
    match error.into_inner().unwrap_or_else(PoisonError::into_inner) {
        None => Ok(results.into_inner().unwrap_or_else(PoisonError::into_inner)),
        Some(error) => Err(error),
    }
}

/// Counts the timeouts of each technique. A submission may be too slow in one scene and right in others, or with one
/// technique and right with others, but the grade gives up on a technique that never finishes.
#[derive(Default)]
struct TimeoutTracker(Mutex<BTreeMap<&'static str, Timeouts>>);

/// The timeouts of one technique.
#[derive(Clone, Copy, Default)]
struct Timeouts {
    total: usize,
    in_a_row: usize,
}

impl TimeoutTracker {
    fn record(&self, check: &CheckResult) {
        let mut all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let timeouts = all.entry(check.id.technique.name()).or_default();
        if check.reason == Reason::Timeout {
            timeouts.total += 1;
            timeouts.in_a_row += 1;
        } else {
            timeouts.in_a_row = 0;
        }
    }

    /// True after two timeouts of this technique in a row or four in total: its remaining checks are not run.
    fn give_up(&self, technique: Technique) -> bool {
        let all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        all.get(technique.name()).is_some_and(|timeouts| timeouts.in_a_row >= 2 || timeouts.total >= 4)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use verdict::sample;

    #[test]
    fn everything_is_done_once_and_an_error_stops_the_rest() {
        let things: Vec<usize> = (0..100).collect();
        let mut done = in_parallel(3, &things, |&thing| Ok(2 * thing)).expect("nothing fails");
        done.sort_unstable();
        assert_eq!(done, (0..100).map(|thing| 2 * thing).collect::<Vec<_>>());

        let begun = AtomicUsize::new(0);
        let failed = in_parallel(1, &things, |&thing| {
            begun.fetch_add(1, Ordering::Relaxed);
            if thing == 7 { Err(Error::Harness("seven".to_owned())) } else { Ok(()) }
        });
        assert!(failed.is_err_and(|error| error.to_string().contains("seven")));
        assert_eq!(begun.into_inner(), 8);
    }

    #[test]
    fn a_technique_that_never_finishes_is_given_up_and_others_are_not() {
        let check = |reason| {
            let id = "light-pick/scripted/nee/1".parse().expect("it is a name");
            CheckResult { id, reason, ..sample::report("").checks[0].clone() }
        };
        let after = |reasons: &[Reason]| {
            let timeouts = TimeoutTracker::default();
            reasons.iter().for_each(|&reason| timeouts.record(&check(reason)));
            assert!(!timeouts.give_up(Technique::Mis));
            timeouts.give_up(Technique::Nee)
        };
        use Reason::{Bias, Timeout};
        assert!(!after(&[Timeout, Bias, Timeout, Bias, Timeout]));
        assert!(after(&[Timeout, Timeout]) && after(&[Timeout, Bias, Timeout, Bias, Timeout, Bias, Timeout]));
    }
}
