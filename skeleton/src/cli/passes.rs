//! Division of the samples into passes.

use std::ops::Range;
use std::time::Duration;

/// Limits of a rendering; it ends at whichever is reached first. At least one of the two is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Limits {
    /// Samples per pixel.
    pub(super) samples: Option<u64>,
    /// Wall-clock time, exceeded only to give each pixel one sample.
    pub(super) time: Option<Duration>,
}

/// Target duration of a pass: short enough for a live display, long enough to keep all threads busy.
const PASS: Duration = Duration::from_millis(200);
/// Maximum ratio of the sizes of two consecutive passes, since timings of small passes are unreliable.
const GROWTH: u64 = 4;

/// Divides the samples of an image into passes of similar duration.
///
/// The image does not depend on the division: each sample has its own random numbers, and each pixel adds its samples
/// in order.
#[derive(Debug)]
pub(super) struct Passes {
    limits: Limits,
    done: u64,
    last: u64,
    seconds_per_sample: f64,
}

impl Passes {
    /// No sample is done yet.
    pub(super) fn new(limits: Limits) -> Self {
        Self { limits, done: 0, last: 0, seconds_per_sample: 0.0 }
    }

    /// Number of samples per pixel done so far.
    pub(super) fn done(&self) -> u64 {
        self.done
    }

    /// The sample numbers of the next pass, given the time since the start; `None` when a limit is reached.
    pub(super) fn next(&self, elapsed: Duration) -> Option<Range<u64>> {
        if self.done == 0 {
            // One sample per pixel, to measure the time it takes.
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
        // The cast saturates if the time was too short to measure.
        let fitting = (seconds / self.seconds_per_sample) as u64;
        let left = self.limits.samples.map_or(u64::MAX, |samples| samples - self.done);
        let count = fitting.clamp(1, GROWTH.saturating_mul(self.last)).min(left);
        (count > 0).then(|| self.done..self.done + count)
    }

    /// Records a finished pass and its duration.
    pub(super) fn finish(&mut self, pass: Range<u64>, took: Duration) {
        self.last = pass.end - pass.start;
        self.done = pass.end;
        self.seconds_per_sample = took.as_secs_f64() / self.last as f64;
    }

    /// Fraction of the work done, in [0, 1].
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

    /// The passes on a machine that takes the given time per sample of all pixels.
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
    fn passes_are_contiguous_up_to_the_last_sample() {
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
    fn passes_approach_the_target_duration() {
        let per_sample = Duration::from_millis(1);
        let (passes, _) = passes(Limits { samples: Some(10_000), time: None }, per_sample);
        let sizes: Vec<u64> = passes.iter().map(|pass| pass.end - pass.start).collect();
        assert_eq!(sizes[..6], [1, 4, 16, 64, 200, 200]);
    }

    #[test]
    fn the_time_limit_ends_them_after_at_least_one_sample() {
        let limits = Limits { samples: None, time: Some(2 * SECOND) };
        let (_, elapsed) = passes(limits, Duration::from_millis(7));
        assert!(elapsed >= 2 * SECOND && elapsed <= 2 * SECOND + Duration::from_millis(7), "{elapsed:?}");
        let (slow, _) = passes(limits, 60 * SECOND);
        assert_eq!((slow.len(), slow[0].end), (1, 1));
    }

    #[test]
    fn the_limit_reached_first_counts() {
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
