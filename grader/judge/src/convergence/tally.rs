//! What was measured of one curve, and the statistics of it.

use super::jackknife::{jackknife, median};
use crate::statistics::regression::line;
use verdict::convergence::{Cost, Estimate, Point};

/// Renderings of one curve by length, shortest first, and block.
#[derive(Clone, Debug, Default)]
pub(super) struct Tally {
    pub(super) levels: Vec<Level>,
}

/// Renderings of one length.
#[derive(Clone, Debug, Default)]
pub(super) struct Level {
    /// Samples per pixel of each rendering.
    pub(super) samples: u64,
    /// One per block.
    pub(super) blocks: Vec<Block>,
}

/// Renderings of one length in one block.
#[derive(Clone, Debug, Default)]
pub(super) struct Block {
    /// Errors of each rendering.
    pub(super) errors: Vec<Errors>,
    /// Processor time of all of them together, in seconds.
    pub(super) seconds: f64,
    /// Rays of all of them together.
    pub(super) rays: u64,
}

/// Errors of one rendering.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Errors {
    pub(super) relative_mse: f64,
    pub(super) trimmed_relative_mse: f64,
    pub(super) mse: f64,
}

impl Level {
    /// The mean over renderings of all blocks but one.
    fn mean(&self, of: impl Fn(&Errors) -> f64, left_out: Option<usize>) -> f64 {
        let errors = || kept(&self.blocks, left_out).flat_map(|block| &block.errors);
        errors().map(of).sum::<f64>() / errors().count().max(1) as f64
    }

    /// The logarithm of a mean error; `None` if the error is not positive, which is pure noise.
    fn ln_error(&self, of: impl Fn(&Errors) -> f64, left_out: Option<usize>) -> Option<f64> {
        Some(self.mean(of, left_out)).filter(|&error| error > 0.0).map(f64::ln)
    }

    /// Processor time of one rendering in seconds.
    fn seconds(&self, left_out: Option<usize>) -> f64 {
        let blocks = || kept(&self.blocks, left_out);
        blocks().map(|block| block.seconds).sum::<f64>() / self.count(left_out)
    }

    fn rays(&self) -> f64 {
        self.blocks.iter().map(|block| block.rays as f64).sum::<f64>() / self.count(None)
    }

    fn count(&self, left_out: Option<usize>) -> f64 {
        kept(&self.blocks, left_out).map(|block| block.errors.len()).sum::<usize>().max(1) as f64
    }

    fn point(&self) -> Option<Point> {
        let blocks = self.blocks.len();
        let estimate = |of: fn(&Errors) -> f64| -> Estimate {
            jackknife(blocks, |out| self.ln_error(of, out))
                .map(Estimate::exp)
                .or_else(|| jackknife(blocks, |out| Some(self.mean(of, out))))
                .unwrap_or_else(|| Estimate::without_interval(self.mean(of, None)))
        };
        let all = self.blocks.iter().flat_map(|block| &block.errors);
        Some(Point {
            samples: self.samples,
            renders: all.clone().count(),
            seconds: self.seconds(None),
            rays: self.rays(),
            relative_mse: estimate(|errors| errors.relative_mse),
            median_relative_mse: Some(median(all.map(|errors| errors.relative_mse).collect())?),
            trimmed_relative_mse: Some(estimate(|errors| errors.trimmed_relative_mse)),
            mse: Some(estimate(|errors| errors.mse)),
        })
    }
}

fn kept(blocks: &[Block], left_out: Option<usize>) -> impl Iterator<Item = &Block> {
    blocks.iter().enumerate().filter(move |(index, _)| Some(*index) != left_out).map(|(_, block)| block)
}

fn relative_mse(errors: &Errors) -> f64 {
    errors.relative_mse
}

impl Tally {
    /// Number of blocks.
    fn blocks(&self) -> usize {
        self.levels.first().map_or(0, |level| level.blocks.len())
    }

    /// The points of the curve.
    pub(super) fn points(&self) -> Vec<Point> {
        self.levels.iter().filter_map(Level::point).collect()
    }

    /// Intercept and slope of ln(relative MSE) over ln(samples). `None` with fewer than three lengths, or if an error is
    /// not positive.
    ///
    /// All lengths have the same number of samples in total, so that the scarcity of a heavy tail in them lowers all
    /// errors alike and leaves the slope unbiased.
    fn error_line(&self, left_out: Option<usize>) -> Option<[f64; 2]> {
        let point =
            |level: &Level| Some(((level.samples as f64).ln(), level.ln_error(relative_mse, left_out)?));
        let points = self.levels.iter().map(point).collect::<Option<Vec<_>>>()?;
        if points.len() < 3 { None } else { line(&points, |_| 1.0) }
    }

    /// The slope of ln(relative MSE) over ln(samples).
    pub(super) fn slope(&self) -> Option<Estimate> {
        jackknife(self.blocks(), |out| Some(self.error_line(out)?[1]))
    }

    /// Overhead and time of one sample per pixel: the line through the times of all lengths, with equal relative errors.
    fn time_line(&self, left_out: Option<usize>) -> Option<[f64; 2]> {
        let points: Vec<(f64, f64)> =
            self.levels.iter().map(|level| (level.samples as f64, level.seconds(left_out))).collect();
        let [overhead, seconds] = line(&points, |seconds| 1.0 / (seconds * seconds)).unwrap_or([0.0; 2]);
        if overhead > 0.0 && seconds > 0.0 {
            return Some([overhead, seconds]);
        }
        // One length only, or less overhead than the noise of the times.
        let (samples, seconds) = points.last().filter(|(_, seconds)| *seconds > 0.0)?;
        Some([0.0, seconds / samples])
    }

    /// Time and rays by samples.
    pub(super) fn cost(&self) -> Option<Cost> {
        let [overhead, _] = self.time_line(None)?;
        let seconds = jackknife(self.blocks(), |out| Some(self.time_line(out)?[1].ln()))?.exp();
        let longest = self.levels.last()?;
        Some(Cost { overhead, seconds, rays: longest.rays() / longest.samples as f64 })
    }

    /// The cost of a sample relative to that of another program in the same blocks.
    pub(super) fn relative_cost(&self, yardstick: &Self) -> Option<Estimate> {
        let ln_cost = |tally: &Self, out| Some(tally.time_line(out)?[1].ln());
        let ratio = |out| Some(ln_cost(self, out)? - ln_cost(yardstick, out)?);
        Some(jackknife(self.blocks(), ratio)?.exp())
    }

    /// Efficiency relative to that of another program in the same blocks: the ratio of 1/(relative MSE × seconds), as the
    /// geometric mean over the longer half of the lengths.
    pub(super) fn efficiency(&self, yardstick: &Self) -> Option<Estimate> {
        let ln_work = |tally: &Self, out| -> Option<f64> {
            let longer = &tally.levels[tally.levels.len() / 2..];
            let works =
                longer.iter().map(|level| Some(level.ln_error(relative_mse, out)? + level.seconds(out).ln()));
            Some(works.sum::<Option<f64>>()? / longer.len() as f64)
        };
        let ratio = |out| Some(ln_work(yardstick, out)? - ln_work(self, out)?);
        Some(jackknife(self.blocks(), ratio)?.exp())
    }

    /// Processor time of a rendering with this relative MSE, in seconds, on the straight line through the curve. `None` if
    /// even the longest renderings have a larger error.
    pub(super) fn seconds_to(&self, target: f64) -> Option<Estimate> {
        let samples = |out| -> Option<f64> {
            let [intercept, slope] = self.error_line(out)?;
            Some(((target.ln() - intercept) / slope).exp()).filter(|_| slope < 0.0)
        };
        if samples(None)? > self.levels.last()?.samples as f64 {
            return None;
        }
        let ln_seconds = |out| {
            let [overhead, seconds] = self.time_line(out)?;
            Some((overhead + seconds * samples(out)?).ln())
        };
        Some(jackknife(self.blocks(), ln_seconds)?.exp())
    }

    /// True if few renderings make up most of the error: at some length, one block has more than a third of it.
    pub(super) fn is_heavy_tailed(&self) -> bool {
        self.levels.iter().any(|level| {
            let of_block = |block: &Block| block.errors.iter().map(relative_mse).sum::<f64>();
            let sums: Vec<f64> = level.blocks.iter().map(of_block).collect();
            let largest = sums.iter().copied().fold(0.0, f64::max);
            sums.len() > 3 && 3.0 * largest > sums.iter().sum()
        })
    }
}
