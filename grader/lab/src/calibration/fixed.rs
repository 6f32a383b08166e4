//! Two simpler tests, to see what looking again and again is worth.
//!
//! Both take a number of samples that is fixed beforehand. Both are held to the nominal rate of false alarms that ours has
//! in one check, divided among what they look at (Šidák). Heavy tails make that rate a wish, so a number of samples is only
//! enough if it gives no alarm in [`DRAWS`] draws of correct samples ([`Quiet`]).

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use arty::sampler::batch_seed;
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use serde::{Deserialize, Serialize};
use statrs::distribution::{ContinuousCDF, Normal, StudentsT};

use super::{Counts, Pool};
use judge::reference::SIZE;
use judge::statistics::bias::smallest_of;
use judge::statistics::regions::{Kind, Region, luminance, pyramid};
use judge::statistics::sequential::Demand;

/// A test of means.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Test {
    /// Ours.
    #[default]
    Sequential,
    /// Welch's t-test of the luminance of 64 tiles against a reference with as many samples (Jung, Hanika and
    /// Dachsbacher, "Detecting Bias in Monte Carlo Renderers using Welch's t-test", JCGT 9(2), 2020).
    Welch,
    /// A z-test of the luminance of each pixel against a reference without noise.
    Pixels,
}

impl Test {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Sequential, Self::Welch, Self::Pixels];

    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Sequential => "sequential",
            Self::Welch => "Welch, fixed N",
            Self::Pixels => "z by pixel, fixed N",
        }
    }
}

/// With how many samples which test gives no alarm in draws of a check's correct samples, as far as that was tried.
#[derive(Default)]
pub struct Quiet(Mutex<BTreeMap<(Test, u64), bool>>);

/// What a test with a fixed number of samples decides on.
#[derive(Clone, Copy)]
pub(super) struct Fixed<'a> {
    /// Which of the two.
    pub(super) test: Test,
    /// What is judged, and how much brighter than recorded.
    pub(super) pool: &'a Pool,
    pub(super) bias: f64,
    /// What is right.
    pub(super) truth: &'a Pool,
    /// How often it may be wrong.
    pub(super) level: f64,
    pub(super) seed: u64,
    /// What is known of the same check's correct samples.
    pub(super) quiet: &'a Quiet,
}

/// Of twenty, how many have to be found for a number of samples to be enough.
const DRAWS: u64 = 20;
const ENOUGH: u64 = 19;

/// The fewest and the most samples of each pixel that are tried. Ours takes up to 10,240.
const FEWEST: u64 = 32;
const MOST: u64 = 8192;

impl Fixed<'_> {
    /// How often it sounds an alarm with so many samples of each pixel.
    pub(super) fn alarms(&self, samples: u64, draws: u64) -> Counts {
        let found = (0..draws).into_par_iter().filter(|&number| self.finds(samples, number)).count() as u64;
        self.counts(samples, draws, found)
    }

    /// With the fewest samples that are enough; with the most, if none are.
    pub(super) fn need(&self) -> Counts {
        let mut samples = FEWEST;
        loop {
            let found = if self.is_quiet(samples) { self.found(samples) } else { 0 };
            if found >= ENOUGH || samples >= MOST {
                return self.counts(samples, DRAWS, found);
            }
            samples *= 2;
        }
    }

    /// How many draws give an alarm; too few, where that is too few.
    fn found(&self, samples: u64) -> u64 {
        let missed = (0..DRAWS).into_par_iter().filter(|&number| !self.finds(samples, number));
        DRAWS - missed.take_any((DRAWS - ENOUGH + 1) as usize).count() as u64
    }

    /// True if no draw of correct samples gives an alarm.
    fn is_quiet(&self, samples: u64) -> bool {
        let known = || self.quiet.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(&quiet) = known().get(&(self.test, samples)) {
            return quiet;
        }
        let right = Fixed { pool: self.truth, bias: 0.0, ..*self };
        // Other draws than those in which something is to be found.
        let quiet = (DRAWS..2 * DRAWS).into_par_iter().all(|number| !right.finds(samples, number));
        known().insert((self.test, samples), quiet);
        quiet
    }

    fn counts(&self, samples: u64, grades: u64, found: u64) -> Counts {
        let pixels = u64::from(SIZE.0 * SIZE.1);
        Counts { grades, biased: found, unclear: grades - found, samples: grades * samples * pixels }
    }

    fn finds(&self, samples: u64, number: u64) -> bool {
        let draw = |pool: &Pool, bias: f64, part: u64| {
            let seed = batch_seed(self.seed ^ part, number);
            let seeds = (0..samples).map(|sample| batch_seed(seed, sample)).collect();
            pool.draw(&Demand { seeds, first_sample: 0, samples: 1 }, bias)
        };
        let own = draw(self.pool, self.bias, 1);
        let smallest = if self.test == Test::Welch {
            let tiles: Vec<Region> = pyramid(SIZE.0, SIZE.1)
                .into_iter()
                .filter(|it| it.level == 3 && it.id.kind == RegionKind::Luminance)
                .collect();
            let right = draw(self.truth, 0.0, 2);
            let p = |tile: &Region| {
                welch(&moments(&own, |image| sum(tile, image)), &moments(&right, |image| sum(tile, image)))
            };
            smallest_of(tiles.len(), tiles.iter().map(p).fold(1.0, f64::min))
        } else {
            let truth = self.truth.mean();
            let p = |pixel: usize| {
                z_test(
                    &moments(&own, |image| luminance(&image[pixel].map(f64::from))),
                    luminance(&truth[pixel]),
                )
            };
            smallest_of(truth.len(), (0..truth.len()).map(p).fold(1.0, f64::min))
        };
        smallest < self.level
    }
}

/// A tile of an image.
fn sum(tile: &Region, image: &[[f32; 3]]) -> f64 {
    let products = |&(pixel, weights): &(usize, [f64; 3])| -> f64 {
        (0..3).map(|channel| weights[channel] * f64::from(image[pixel][channel])).sum()
    };
    tile.weights.iter().map(products).sum()
}

/// Number, mean, and variance of the mean.
struct Moments {
    count: f64,
    mean: f64,
    variance: f64,
}

fn moments(images: &[Vec<[f32; 3]>], value: impl Fn(&[[f32; 3]]) -> f64) -> Moments {
    let count = images.len() as f64;
    let values: Vec<f64> = images.iter().map(|image| value(image)).collect();
    let mean = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    Moments { count, mean, variance: squares / (count - 1.0) / count }
}

/// The two-sided p-value of Welch's test, with the degrees of freedom of Welch and Satterthwaite.
fn welch(a: &Moments, b: &Moments) -> f64 {
    let variance = a.variance + b.variance;
    if variance == 0.0 {
        return f64::from(u8::from(a.mean == b.mean));
    }
    let freedom =
        variance.powi(2) / (a.variance.powi(2) / (a.count - 1.0) + b.variance.powi(2) / (b.count - 1.0));
    let t = (a.mean - b.mean).abs() / variance.sqrt();
    StudentsT::new(0.0, 1.0, freedom).map_or(1.0, |distribution| 2.0 * distribution.sf(t))
}

/// The two-sided p-value of a mean that should be `truth`.
fn z_test(own: &Moments, truth: f64) -> f64 {
    if own.variance == 0.0 {
        return f64::from(u8::from((own.mean - truth).abs() <= 1e-6 * truth.abs()));
    }
    let z = (own.mean - truth).abs() / own.variance.sqrt();
    Normal::new(0.0, 1.0).map_or(1.0, |distribution| 2.0 * distribution.sf(z))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn welch_gives_the_p_value_of_tables() {
        // Means 0 and 2, variances of the mean 0.5 each, 10 samples each: t = 2 with 18 degrees of freedom.
        let sample = |mean| Moments { count: 10.0, mean, variance: 0.5 };
        assert!((welch(&sample(0.0), &sample(2.0)) - 0.0608).abs() < 1e-4);
        assert!((z_test(&Moments { count: 9.0, mean: 1.96, variance: 1.0 }, 0.0) - 0.05).abs() < 1e-4);
    }

    #[test]
    fn a_small_error_takes_more_samples_than_a_large_one() {
        // Exponentially distributed samples, independent from pixel to pixel.
        let image = |number: u64| {
            let mut random = arty::sampler::Sampler::new(number, (0, 0), 0);
            (0..256).map(|_| [-(1.0 - random.next_1d()).ln(); 3]).collect()
        };
        let (pool, quiet) = (Pool::of((0..4096).map(image).collect()), Quiet::default());
        for test in [Test::Welch, Test::Pixels] {
            let need = |bias| {
                Fixed { test, pool: &pool, bias, truth: &pool, level: 1e-6, seed: 1, quiet: &quiet }.need()
            };
            let (large, small) = (need(1.0), need(0.3));
            assert!(large.biased >= ENOUGH && small.biased >= ENOUGH, "{test:?}: {large:?} {small:?}");
            assert!(small.samples > 2 * large.samples, "{test:?}: {large:?} {small:?}");
            let none =
                Fixed { test, pool: &pool, bias: 0.0, truth: &pool, level: 1e-6, seed: 1, quiet: &quiet }
                    .alarms(256, 20);
            assert_eq!(none.biased, 0, "{test:?}: nominally 2e-5");
        }
    }

    #[test]
    fn what_gives_false_alarms_finds_nothing() {
        // One sample in ten thousand is ten thousand times as bright: a z-test knows neither mean nor variance.
        let image = |number: u64| {
            let mut random = arty::sampler::Sampler::new(number, (0, 0), 0);
            (0..256)
                .map(|_| [if random.next_1d() < 1e-4 { 1e4 } else { 0.1 * random.next_1d() }; 3])
                .collect()
        };
        let (pool, quiet) = (Pool::of((0..4096).map(image).collect()), Quiet::default());
        let fixed = |bias| Fixed {
            test: Test::Pixels,
            pool: &pool,
            bias,
            truth: &pool,
            level: 1e-6,
            seed: 1,
            quiet: &quiet,
        };
        assert_eq!(fixed(0.0).alarms(FEWEST, 20).biased, 20);
        assert_eq!(fixed(0.0).found(FEWEST), DRAWS);
        assert!(!fixed(0.05).is_quiet(FEWEST));
        assert!(fixed(0.05).need().samples > 64 * FEWEST * u64::from(SIZE.0 * SIZE.1));
    }
}
