//! How often are correct hand-ins failed, and how small an error is found?
//!
//! Whole grades are dear: a thousand of them take an hour. So the statistics are calibrated alone as well: for each
//! correct variant and each check by means, thousands of single samples of each pixel are [recorded](pool::Pool), heavy
//! tails and all, and drawn from with replacement. In that world the true mean is known, that of the pool, and a grade
//! costs a millisecond. A bias is put in by brightening all samples.

mod pool;
mod results;
mod table;

pub use pool::Pool;
pub use results::{Counts, Line, Results};
pub use table::table;

use rayon::iter::{IntoParallelIterator, ParallelIterator};

use crate::statistics::bias::Expected;
use crate::statistics::regions::{Region, pyramid, weighted_image};
use crate::statistics::sequential::{LOOKS, Question, judge};

/// A check by means whose statistics are tried.
pub struct Trial<'a> {
    /// Recorded samples.
    pub pool: &'a Pool,
    /// The noise that the check expects; its means are not used.
    pub expected: &'a Expected,
    /// The relative error that a pass excludes.
    pub tolerance: f64,
    /// The share of the screening level that the check may spend.
    pub screening_level: f64,
}

impl Trial<'_> {
    /// Judges `count` grades drawn from the pool, with all samples `1 + bias` times as bright.
    pub fn run(&self, count: u64, bias: f64, seed: u64) -> Counts {
        let (width, height) = crate::reference::SIZE;
        let expected = Expected {
            mean: self.pool.mean(),
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
