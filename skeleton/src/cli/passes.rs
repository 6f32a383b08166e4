//! How many samples to take at a time, and when to stop.

use std::ops::Range;
use std::time::Duration;

/// When to stop, whichever comes first. At least one of the two is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Limits {
    /// This many samples per pixel.
    pub(super) samples: Option<u64>,
    /// This long, but at least one sample per pixel.
    pub(super) time: Option<Duration>,
}

/// How long a pass should take: short enough to look alive, long enough for threads to have something to share.
const PASS: Duration = Duration::from_millis(200);
/// A pass is at most this many times as large as the one before, since the first ones are hard to time.
const GROWTH: u64 = 4;

/// Divides the samples of a picture into passes of about the same time.
///
/// The picture does not depend on it: each sample has its own random numbers, and each pixel adds them in order.
#[derive(Debug)]
pub(super) struct Passes {
    limits: Limits,
    done: u64,
    last: u64,
    seconds_per_sample: f64,
}

impl Passes {
    /// Nothing is done yet.
    pub(super) fn new(limits: Limits) -> Self {
        Self { limits, done: 0, last: 0, seconds_per_sample: 0.0 }
    }

    /// How many samples per pixel are done.
    pub(super) fn done(&self) -> u64 {
        self.done
    }

    /// The numbers of the samples to take next, given how long it has been since the start; `None` at the end.
    pub(super) fn next(&self, elapsed: Duration) -> Option<Range<u64>> {
        if self.done == 0 {
            // One sample per pixel, to see how long it takes.
            return Some(0..1);
        }
        let mut seconds = PASS.as_secs_f64();
        if let Some(time) = self.limits.time {
            let left = time.saturating_sub(elapsed);
            if left.is_zero() {
                return None;
            }
            seconds = seconds.min(left.as_secs_f64());
        }
        // The cast saturates where a sample took no measurable time.
        let fitting = (seconds / self.seconds_per_sample) as u64;
        let left = self.limits.samples.map_or(u64::MAX, |samples| samples - self.done);
        let count = fitting.clamp(1, GROWTH.saturating_mul(self.last)).min(left);
        (count > 0).then(|| self.done..self.done + count)
    }

    /// Takes note of a pass: its samples, and how long it took.
    pub(super) fn finish(&mut self, pass: Range<u64>, took: Duration) {
        self.last = pass.end - pass.start;
        self.done = pass.end;
        self.seconds_per_sample = took.as_secs_f64() / self.last as f64;
    }

    /// The share of all work that is done, in [0, 1].
    pub(super) fn fraction(&self, elapsed: Duration) -> f64 {
        let by_samples = self.limits.samples.map_or(0.0, |samples| self.done as f64 / samples as f64);
        let by_time = self.limits.time.map_or(0.0, |time| elapsed.as_secs_f64() / time.as_secs_f64());
        by_samples.max(by_time).min(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SECOND: Duration = Duration::from_secs(1);

    /// The passes of a computer that takes the given time for a sample of all pixels.
    fn passes(limits: Limits, per_sample: Duration) -> (Vec<Range<u64>>, Duration) {
        let mut passes = Passes::new(limits);
        let (mut all, mut elapsed) = (Vec::new(), Duration::ZERO);
        while let Some(pass) = passes.next(elapsed) {
            let took = per_sample * (pass.end - pass.start) as u32;
            elapsed += took;
            passes.finish(pass.clone(), took);
            all.push(pass);
        }
        (all, elapsed)
    }

    #[test]
    fn passes_follow_each_other_to_the_last_sample() {
        for per_sample in [Duration::ZERO, Duration::from_micros(3), Duration::from_millis(15), 2 * SECOND] {
            for samples in [1, 2, 8, 1000] {
                let (passes, _) = passes(Limits { samples: Some(samples), time: None }, per_sample);
                assert_eq!(passes[0].start, 0);
                assert_eq!(passes[passes.len() - 1].end, samples);
                assert!(passes.windows(2).all(|pair| pair[0].end == pair[1].start));
            }
        }
    }

    #[test]
    fn passes_take_about_as_long_as_they_should() {
        let per_sample = Duration::from_millis(1);
        let (passes, _) = passes(Limits { samples: Some(10_000), time: None }, per_sample);
        let sizes: Vec<u64> = passes.iter().map(|pass| pass.end - pass.start).collect();
        assert_eq!(sizes[..6], [1, 4, 16, 64, 200, 200]);
    }

    #[test]
    fn time_ends_them_too_but_not_before_the_first_sample() {
        let limits = Limits { samples: None, time: Some(2 * SECOND) };
        let (_, elapsed) = passes(limits, Duration::from_millis(7));
        assert!(elapsed >= 2 * SECOND && elapsed <= 2 * SECOND + Duration::from_millis(7), "{elapsed:?}");
        let (slow, _) = passes(limits, 60 * SECOND);
        assert_eq!((slow.len(), slow[0].end), (1, 1));
    }

    #[test]
    fn whichever_limit_comes_first_counts() {
        let limits = Limits { samples: Some(50), time: Some(10 * SECOND) };
        let (few, elapsed) = passes(limits, Duration::from_millis(1));
        assert_eq!((few[few.len() - 1].end, elapsed), (50, Duration::from_millis(50)));
        let (slow, elapsed) = passes(limits, SECOND);
        assert_eq!((slow[slow.len() - 1].end, elapsed), (10, 10 * SECOND));
    }

    #[test]
    fn the_fraction_is_that_of_the_nearer_limit() {
        let mut passes = Passes::new(Limits { samples: Some(10), time: Some(100 * SECOND) });
        passes.finish(0..2, SECOND);
        assert_eq!(passes.fraction(SECOND), 0.2);
        assert_eq!(passes.fraction(70 * SECOND), 0.7);
        assert_eq!(passes.fraction(200 * SECOND), 1.0);
    }
}
