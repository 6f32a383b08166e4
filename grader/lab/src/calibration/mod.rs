//! How often are correct submissions failed, and how small an error is found?
//!
//! Whole grades are dear: a thousand of them take an hour. So the statistics are calibrated alone as well: for each
//! correct variant and each check by means, thousands of single samples of each pixel are [recorded](pool::Pool), heavy
//! tails and all, and drawn from with replacement. In that world the true mean is known, that of the pool, and a grade
//! costs a millisecond. A bias is put in by brightening all samples. Two simpler [tests](Test) are given the same samples,
//! to see what ours saves; and all three are given those of wrong variants.

mod fixed;
mod plot;
mod pool;
mod results;
mod table;

pub use fixed::{Quiet, Test};
pub use plot::svg;
pub use pool::Pool;
pub use results::{Counts, Line, Results};
pub use table::table;

use rayon::iter::{IntoParallelIterator, ParallelIterator};

use fixed::Fixed;
use judge::statistics::bias::Expected;
use judge::statistics::regions::{Region, pyramid, weighted_image};
use judge::statistics::sequential::{CONFIRMATION_LEVEL, LOOKS, Question, judge};

/// Samples of each pixel with which the false alarms of tests with a fixed number are counted.
const FIXED_SAMPLES: u64 = 1024;

/// A check by means whose statistics are tried.
pub struct Trial<'a> {
    /// Recorded samples.
    pub pool: &'a Pool,
    /// Recorded samples of a correct program: the same pool, unless a wrong one is judged.
    pub truth: &'a Pool,
    /// The noise that the check expects; its means are not used.
    pub expected: &'a Expected,
    /// The relative error that a pass excludes.
    pub tolerance: f64,
    /// The share of the screening level that the check may spend.
    pub screening_level: f64,
    /// What the simpler tests make of the correct samples.
    pub quiet: &'a Quiet,
}

impl Trial<'_> {
    /// Judges draws from the pool, with all samples `1 + bias` times as bright: `count` of them by our test and wherever
    /// nothing is to be found, and as many as tell whether an error is found by the others.
    pub fn run(&self, test: Test, count: u64, bias: f64, seed: u64) -> Counts {
        let level = self.screening_level * CONFIRMATION_LEVEL;
        let fixed = Fixed { test, pool: self.pool, bias, truth: self.truth, level, seed, quiet: self.quiet };
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
            let question = Question {
                expected: &expected,
                regions: &regions,
                decisive: regions.len() - 1,
                tolerance: self.tolerance,
                screening_level: self.screening_level,
                seed: arty::sampler::batch_seed(seed, number),
                looks: LOOKS.len(),
            };
            let drawn =
                judge(&question, |demand| Ok::<_, std::convert::Infallible>(self.pool.draw(demand, bias)));
            match drawn {
                Ok(judgement) => Counts::of(judgement.decision, judgement.samples),
                Err(never) => match never {},
            }
        };
        (0..count).into_par_iter().map(one).reduce(Counts::default, std::ops::Add::add)
    }
}
