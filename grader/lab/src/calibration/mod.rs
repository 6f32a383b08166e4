//! How often do correct submissions fail, and how small an error is found?
//!
//! Whole grades are expensive: a thousand of them take an hour. So the statistics are also calibrated alone: for each
//! correct variant and each check of means, thousands of single samples of each pixel are [recorded](pool::Pool), heavy
//! tails included, and drawn with replacement. The true mean of such draws is known, that of the pool, and a grade costs
//! a millisecond. A bias is simulated by scaling all samples. Two simpler [tests](Test) get the same samples, to see what
//! the sequential test saves; and all three get those of wrong variants. [`Experiment`] runs all of it.

mod experiment;
mod fixed;
mod plot;
mod pool;
mod results;
mod table;

pub use experiment::{Effort, Experiment};
pub use fixed::{AlarmCache, Test};
pub use plot::svg;
pub use pool::Pool;
pub use results::{Counts, Line, Results};
pub use table::table;

use rayon::iter::{IntoParallelIterator, ParallelIterator};

use fixed::Fixed;
use judge::statistics::expected::Expected;
use judge::statistics::regions::{Region, pyramid, weighted_image};
use judge::statistics::sequential::{CONFIRMATION_LEVEL, LOOKS, SequentialTest, judge};

/// Samples per pixel with which the false alarms of the tests of fixed size are counted.
const FIXED_SAMPLES: u64 = 1024;

/// The statistics of one check, applied to recorded samples.
pub struct Trial<'a> {
    /// Samples that are judged.
    pub pool: &'a Pool,
    /// Samples of a correct program: the same pool, unless a wrong variant is judged.
    pub truth: &'a Pool,
    /// Distribution that the check expects; its means are not used.
    pub expected: &'a Expected,
    /// Relative error that a pass excludes.
    pub tolerance: f64,
    /// Share of the screening level that the check may spend.
    pub screening_level: f64,
    /// False alarms of the tests of fixed size on the correct samples.
    pub alarms: &'a AlarmCache,
}

impl Trial<'_> {
    /// Judges draws from the pool with all samples multiplied by `1 + bias`. The sequential test judges `count` draws, and
    /// so do the others where there is no error to find; where there is one, they judge as many as it takes to tell whether
    /// they find it.
    pub fn run(&self, test: Test, count: u64, bias: f64, seed: u64) -> Counts {
        let level = self.screening_level * CONFIRMATION_LEVEL;
        let fixed = Fixed { test, pool: self.pool, bias, truth: self.truth, level, seed, known: self.alarms };
        match test {
            Test::Sequential => self.judge(count, bias, seed),
            _ if bias == 0.0 && std::ptr::eq(self.pool, self.truth) => fixed.alarms(FIXED_SAMPLES, count),
            _ => fixed.need(),
        }
    }

    fn judge(&self, count: u64, bias: f64, seed: u64) -> Counts {
        let (width, height) = judge::reference::SIZE;
        let expected = Expected {
            mean: self.truth.mean(),
            error: vec![[0.0; 3]; self.expected.mean.len()],
            ..self.expected.clone()
        };
        let mut regions: Vec<Region> = pyramid(width, height);
        regions.push(weighted_image(&expected));
        let one = |number: u64| {
            let test = SequentialTest {
                expected: &expected,
                regions: &regions,
                decisive: regions.len() - 1,
                tolerance: self.tolerance,
                screening_level: self.screening_level,
                seed: arty::sampler::batch_seed(seed, number),
                looks: LOOKS.len(),
            };
            let drawn =
                judge(&test, |request| Ok::<_, std::convert::Infallible>(self.pool.draw(request, bias)));
            match drawn {
                Ok(judgement) => Counts::of(judgement.decision, judgement.samples),
                Err(never) => match never {},
            }
        };
        (0..count).into_par_iter().map(one).reduce(Counts::default, std::ops::Add::add)
    }
}
