//! Which pass comes next: coarse pictures right after a change, then samples for all pixels.

use std::ops::Range;
use std::time::Duration;

/// Time for the first picture after a change. With what the window itself needs, it is on the screen within 50 ms.
const FIRST: Duration = Duration::from_millis(20);
/// Target duration of later passes: short enough for a live display, long enough to keep all threads busy.
const PASS: Duration = Duration::from_millis(120);
/// Maximum ratio of the sizes of two consecutive passes, since timings of small passes are unreliable.
const GROWTH: u64 = 4;
/// The first divisor where nothing has been measured, and the largest.
const COARSEST: u32 = 16;

/// What to render next.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Pass {
    /// One sample per pixel of a picture whose sides are divided by this number, at least 2.
    Coarse(u32),
    /// Samples with these numbers for all pixels.
    Samples(Range<u64>),
}

/// How far a picture is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Progress {
    /// Divisor of the last coarse picture; `None` before the first.
    pub coarse: Option<u32>,
    /// Samples per pixel.
    pub samples: u64,
    /// Samples per pixel of the last pass.
    pub last: u64,
}

/// The time a sample of a pixel takes, on all threads together; `None` before the first pass.
///
/// Pictures from another camera or by another technique take a similar time, so it is kept when they change.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Speed(Option<f64>);

impl Speed {
    /// Records a pass.
    pub fn measure(&mut self, pixels: u64, samples: u64, took: Duration) {
        self.0 = Some(took.as_secs_f64() / (pixels * samples).max(1) as f64);
    }
}

/// The next pass of a picture with this number of pixels; `None` when it has `limit` samples per pixel.
pub fn next(progress: Progress, pixels: u64, speed: Speed, limit: Option<u64>) -> Option<Pass> {
    let seconds = speed.0.map(|of_one| of_one * pixels as f64);
    if progress.samples > 0 {
        let fitting = seconds.map_or(1, |seconds| (PASS.as_secs_f64() / seconds) as u64);
        let left = limit.map_or(u64::MAX, |limit| limit.saturating_sub(progress.samples));
        let count = fitting.clamp(1, GROWTH.saturating_mul(progress.last.max(1))).min(left);
        return (count > 0).then(|| Pass::Samples(progress.samples..progress.samples + count));
    }
    let divisor = match (progress.coarse, seconds) {
        (Some(last), _) => last / 2,
        (None, Some(seconds)) => first_divisor(seconds),
        (None, None) => COARSEST,
    };
    Some(if divisor < 2 { Pass::Samples(0..1) } else { Pass::Coarse(divisor) })
}

/// The smallest divisor, a power of two, with which a picture takes no longer than [`FIRST`].
fn first_divisor(seconds: f64) -> u32 {
    let mut divisor = 1;
    while divisor < COARSEST && seconds / f64::from(divisor * divisor) > FIRST.as_secs_f64() {
        divisor *= 2;
    }
    divisor
}

#[cfg(test)]
mod tests {
    use super::*;

    const PIXELS: u64 = 1000;

    /// The passes on a machine where one sample of all pixels takes this time.
    fn passes(per_sample: Duration, known: bool, count: usize, limit: Option<u64>) -> Vec<Pass> {
        let mut speed = Speed::default();
        if known {
            speed.measure(PIXELS, 1, per_sample);
        }
        let mut progress = Progress::default();
        let mut all = Vec::new();
        while all.len() < count
            && let Some(pass) = next(progress, PIXELS, speed, limit)
        {
            match &pass {
                Pass::Coarse(divisor) => progress.coarse = Some(*divisor),
                Pass::Samples(range) => {
                    progress.last = range.end - range.start;
                    progress.samples = range.end;
                }
            }
            speed.measure(PIXELS, 1, per_sample);
            all.push(pass);
        }
        all
    }

    #[test]
    fn the_first_picture_takes_no_longer_than_its_time() {
        for milliseconds in [1_u32, 20, 21, 100, 700, 5000] {
            let seconds = f64::from(milliseconds) / 1000.0;
            let first = passes(Duration::from_millis(milliseconds.into()), true, 1, None).remove(0);
            let divisor = match first {
                Pass::Coarse(divisor) => divisor,
                Pass::Samples(range) => {
                    assert_eq!(range, 0..1);
                    1
                }
            };
            assert!(
                seconds / f64::from(divisor * divisor) <= FIRST.as_secs_f64(),
                "{milliseconds} ms: {divisor}"
            );
        }
    }

    #[test]
    fn coarse_pictures_get_finer_until_every_pixel_has_a_sample() {
        use Pass::{Coarse, Samples};
        let expected = [Coarse(16), Coarse(8), Coarse(4), Coarse(2), Samples(0..1), Samples(1..2)];
        assert_eq!(passes(Duration::from_millis(300), false, 6, None), expected);
        assert_eq!(passes(Duration::from_millis(300), true, 2, None), [Coarse(4), Coarse(2)]);
    }

    #[test]
    fn later_passes_approach_their_duration_and_end_at_the_limit() {
        use Pass::Samples;
        let expected = [Samples(0..1), Samples(1..5), Samples(5..17), Samples(17..29), Samples(29..30)];
        assert_eq!(passes(Duration::from_millis(10), true, 9, Some(30)), expected);
    }
}
