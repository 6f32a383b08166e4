//! How a process spends its time: a busy machine costs it nothing.

use std::process::Child;
use std::time::{Duration, Instant};

use super::system;

/// Maximum wall time of whatever has a limit of processor time, as a multiple of that. Only a process that hardly ever
/// gets a processor reaches it.
pub(crate) const BUSY: u32 = 20;

/// Shorter waiting cannot be told from that of the pipe and of its reader.
const SHORT: Duration = Duration::from_millis(50);

/// Observes how a process spends its time, job by job.
#[derive(Debug)]
pub(crate) struct Watch {
    /// Begin of the job.
    start: Instant,
    /// Processor time before the job; `None` where the system does not tell.
    before: Option<Duration>,
    /// Delay before the job, and as far as it is known by now.
    ///
    /// It is looked up for jobs with waiting only, as the kernel's answer costs more than many a job; delays of others
    /// count for the next such job.
    delays: [Duration; 2],
}

/// How a process has spent its time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Spent {
    /// Processor time over all threads. Wall time where the system does not tell.
    pub(crate) computed: Duration,
    /// Time in which no thread ran or was ready to run: it slept or waited for a lock.
    pub(crate) waited: Duration,
    /// Wall time.
    pub(crate) wall: Duration,
}

impl Watch {
    /// Starts to observe a process that has just been started.
    pub(crate) fn start(child: &Child) -> Self {
        Self { start: Instant::now(), before: system::processor_time(child), delays: [Duration::ZERO; 2] }
    }

    /// Begins the next job.
    pub(crate) fn next(&mut self, child: &Child) {
        *self = Self { delays: [self.delays[1]; 2], ..Self::start(child) };
    }

    /// How the process has spent its time since the start of its job.
    pub(crate) fn spent(&mut self, child: &Child) -> Spent {
        let wall = self.start.elapsed();
        let Some((before, now)) = self.before.zip(system::processor_time(child)) else {
            return Spent { computed: wall, waited: Duration::ZERO, wall };
        };
        let computed = now.saturating_sub(before);
        let waited = self.waited(wall.saturating_sub(computed), || system::delay(child));
        Spent { computed, waited, wall }
    }

    /// Waiting time within `rest`, the time in which the process did not compute. `delay` tells for how long its threads
    /// have been ready to run while others had the processors, over all threads since it was started; `None` where the
    /// system does not tell.
    fn waited(&mut self, rest: Duration, delay: impl FnOnce() -> Option<Duration>) -> Duration {
        if rest <= SHORT {
            return Duration::ZERO;
        }
        self.delays[1] = delay().unwrap_or(self.delays[1]);
        rest.saturating_sub(self.delays[1].saturating_sub(self.delays[0]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_in_which_others_had_the_processors_is_no_waiting() {
        let before = Duration::from_secs(2);
        let waited = |rest: u64, delayed: u64| {
            let mut watch = Watch { start: Instant::now(), before: None, delays: [before; 2] };
            let delay = || Some(before + Duration::from_secs(delayed));
            watch.waited(Duration::from_secs(rest), delay).as_secs()
        };
        assert_eq!((waited(10, 0), waited(9, 3), waited(9, 9), waited(4, 9)), (10, 6, 0, 0));
    }

    #[test]
    fn where_delays_are_unknown_a_process_that_does_not_compute_waits() {
        let mut watch = Watch { start: Instant::now(), before: None, delays: [Duration::ZERO; 2] };
        assert_eq!(watch.waited(Duration::from_secs(9), || None).as_secs(), 9);
    }

    #[test]
    fn delays_are_looked_up_for_long_waiting_only() {
        let mut watch = Watch { start: Instant::now(), before: None, delays: [Duration::ZERO; 2] };
        let looked_up = || unreachable!("the kernel was asked");
        assert_eq!(watch.waited(SHORT, looked_up), Duration::ZERO);
    }
}
