//! How a process spends its time: a busy machine costs it nothing.

use std::process::Child;
use std::time::{Duration, Instant};

use super::system;

/// Maximum wall time of whatever has a limit of processor time, as a multiple of that. Only a process that hardly ever
/// gets a processor reaches it.
pub(crate) const BUSY: u32 = 20;

/// What a process has used of the processors.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Usage {
    /// Processor time over all threads.
    pub(crate) computed: Duration,
    /// Time for which threads were ready to run while other processes had the processors, over all threads; `None` where
    /// the system does not tell.
    pub(crate) delayed: Option<Duration>,
}

/// Observes a process from a moment on.
#[derive(Debug)]
pub(crate) struct Watch {
    start: Instant,
    before: Option<Usage>,
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
    /// Starts to observe a process.
    pub(crate) fn start(child: &Child) -> Self {
        Self { start: Instant::now(), before: system::usage(child) }
    }

    /// How the process has spent its time since the start.
    pub(crate) fn spent(&self, child: &Child) -> Spent {
        let wall = self.start.elapsed();
        match self.before.zip(system::usage(child)) {
            Some((before, now)) => Spent::between(before, now, wall),
            None => Spent { computed: wall, waited: Duration::ZERO, wall },
        }
    }
}

impl Spent {
    fn between(before: Usage, now: Usage, wall: Duration) -> Self {
        let computed = now.computed.saturating_sub(before.computed);
        let delayed = before.delayed.zip(now.delayed).map(|(before, now)| now.saturating_sub(before));
        let waited = wall.saturating_sub(computed + delayed.unwrap_or_default());
        Self { computed, waited, wall }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn usage(computed: u64, delayed: Option<u64>) -> Usage {
        Usage { computed: Duration::from_secs(computed), delayed: delayed.map(Duration::from_secs) }
    }

    #[test]
    fn time_in_which_others_had_the_processors_is_no_waiting() {
        let spent = |computed: u64, delayed: u64| {
            Spent::between(usage(1, Some(2)), usage(1 + computed, Some(2 + delayed)), Duration::from_secs(10))
        };
        let waited = |computed: u64, delayed: u64| spent(computed, delayed).waited.as_secs();
        assert_eq!((waited(0, 0), waited(4, 0), waited(1, 9), waited(20, 0)), (10, 6, 0, 0));
        assert_eq!(spent(20, 0).computed.as_secs(), 20);
        // Where delays are not known, a process that does not compute waits.
        let unknown = Spent::between(usage(0, None), usage(1, None), Duration::from_secs(10));
        assert_eq!(unknown.waited.as_secs(), 9);
    }
}
