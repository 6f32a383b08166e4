//! Running the checks of a grade, several side by side.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use super::points::lost_to;
use super::select::Selected;
use crate::checks::{GradeContext, out_of_time, skipped};
use verdict::check::{CheckResult, Reason};
use verdict::error::{Error, Result};

/// Checks at a time. Each one's process has all the threads of the grade, so that the last to end leaves no core idle;
/// more at a time would only wait for each other.
const MAX_CONCURRENT: usize = 4;

/// Runs checks, and gives their results in the order in which they were named. `on_check` is told of each as it ends.
///
/// Required checks come first. A task that has lost all of its points by them gets only short looks from then on: there
/// is nothing to be won any more, and what is wrong mostly shows at once. Checks that go further than known scenes are
/// skipped there. Which tasks those are depends on verdicts alone, not on how many checks run at a time.
///
/// # Errors
/// What is not the submission's doing.
pub(super) fn run(
    context: &GradeContext<'_>,
    selected: &Selected<'_>,
    on_check: impl FnMut(&CheckResult) + Send,
) -> Result<Vec<CheckResult>> {
    let on_check = Mutex::new(on_check);
    let (timeouts, shortened) = (TimeoutTracker::default(), context.with_short_looks());
    let run_one = |(number, (task, spec)), required: &[CheckResult]| {
        let result = match lost_to(task, required) {
            _ if timeouts.give_up() => out_of_time(task, spec),
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

/// Does things one after the other on each of several threads, and stops early at an error.
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

/// How long a submission is waited for: one scene may be too much for it although it is right in others, but nobody
/// waits for one that never ends.
#[derive(Default)]
struct TimeoutTracker {
    late: AtomicUsize,
    late_in_a_row: AtomicUsize,
}

impl TimeoutTracker {
    fn record(&self, check: &CheckResult) {
        if check.reason == Reason::Timeout {
            self.late.fetch_add(1, Ordering::Relaxed);
            self.late_in_a_row.fetch_add(1, Ordering::Relaxed);
        } else {
            self.late_in_a_row.store(0, Ordering::Relaxed);
        }
    }

    /// True if no more checks are worth their time.
    fn give_up(&self) -> bool {
        self.late_in_a_row.load(Ordering::Relaxed) >= 2 || self.late.load(Ordering::Relaxed) >= 4
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use verdict::sample;

    #[test]
    fn all_is_done_once_and_an_error_ends_it() {
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
    fn nobody_waits_for_a_submission_that_never_ends() {
        let check = |reason| CheckResult { reason, ..sample::report("").checks[0].clone() };
        let after = |reasons: &[Reason]| {
            let timeouts = TimeoutTracker::default();
            reasons.iter().for_each(|&reason| timeouts.record(&check(reason)));
            timeouts.give_up()
        };
        use Reason::{Bias, Timeout};
        assert!(!after(&[Timeout, Bias, Timeout, Bias, Timeout]));
        assert!(after(&[Timeout, Timeout]) && after(&[Timeout, Bias, Timeout, Bias, Timeout, Bias, Timeout]));
    }
}
