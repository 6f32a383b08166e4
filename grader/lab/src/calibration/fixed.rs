//! Two simpler tests, as a baseline for the sequential one.
//!
//! Both take a number of samples that is fixed in advance, at the nominal rate of false alarms that the sequential test has
//! in one check, divided among all that they compare (Šidák). Heavy tails break that nominal rate, so a number of samples
//! only counts as enough if it gives no alarm in [`DRAWS`] draws of correct samples ([`AlarmCache`]).

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use arty::sampler::batch_seed;
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use serde::{Deserialize, Serialize};
use statrs::distribution::{ContinuousCDF, Normal, StudentsT};

use super::{Counts, Pool};
use judge::reference::SIZE;
use judge::statistics::bias::min_p_value;
use judge::statistics::regions::{Region, luminance, pyramid};
use judge::statistics::sequential::SampleRequest;
use verdict::check::RegionKind;

/// A test of means.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Test {
    /// The test that the grader uses.
    #[default]
    Sequential,
    /// Welch's t-test of the luminance of 64 tiles against a reference with as many samples (Jung, Hanika and
    /// Dachsbacher, "Detecting Bias in Monte Carlo Renderers using Welch's t-test", JCGT 9(2), 2020).
    Welch,
    /// A z-test of the luminance of each pixel against a reference without noise.
    Pixels,
}

impl Test {
    /// All tests.
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

/// For the correct samples of one check: whether a test with a number of samples per pixel gives no alarm in any draw.
#[derive(Default)]
pub struct AlarmCache(Mutex<BTreeMap<(Test, u64), bool>>);

/// A test with a fixed number of samples, and the samples that it is applied to.
#[derive(Clone, Copy)]
pub(super) struct Fixed<'a> {
    /// Test to apply; never the sequential one.
    pub(super) test: Test,
    /// Samples that are judged.
    pub(super) pool: &'a Pool,
    /// Relative error that is added to them.
    pub(super) bias: f64,
    /// Correct samples.
    pub(super) truth: &'a Pool,
    /// Nominal probability of a false alarm.
    pub(super) level: f64,
    /// Seed of all draws.
    pub(super) seed: u64,
    /// False alarms on the correct samples.
    pub(super) known: &'a AlarmCache,
}

/// Draws with which a number of samples is tried.
const DRAWS: u64 = 20;

/// Draws in which the error must be found for a number of samples to be enough.
const ENOUGH: u64 = 19;

/// Smallest number of samples per pixel that is tried.
const MIN_SAMPLES: u64 = 32;

/// Largest number of samples per pixel that is tried. The sequential test takes up to 10,240.
const MAX_SAMPLES: u64 = 8192;

impl Fixed<'_> {
    /// Alarms in `draws` draws of `samples` samples per pixel.
    pub(super) fn alarms(&self, samples: u64, draws: u64) -> Counts {
        let found = (0..draws).into_par_iter().filter(|&number| self.finds(samples, number)).count() as u64;
        self.counts(samples, draws, found)
    }

    /// The result with the smallest number of samples that is enough, or with the largest one if none is.
    pub(super) fn need(&self) -> Counts {
        let mut samples = MIN_SAMPLES;
        loop {
            let found = if self.has_no_false_alarm(samples) { self.found(samples) } else { 0 };
            if found >= ENOUGH || samples >= MAX_SAMPLES {
                return self.counts(samples, DRAWS, found);
            }
            samples *= 2;
        }
    }

    /// Draws that give an alarm. Stops counting as soon as fewer than [`ENOUGH`] can.
    fn found(&self, samples: u64) -> u64 {
        let missed = (0..DRAWS).into_par_iter().filter(|&number| !self.finds(samples, number));
        DRAWS - missed.take_any((DRAWS - ENOUGH + 1) as usize).count() as u64
    }

    /// True if no draw of correct samples gives an alarm.
    fn has_no_false_alarm(&self, samples: u64) -> bool {
        let known = || self.known.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(&answer) = known().get(&(self.test, samples)) {
            return answer;
        }
        let right = Fixed { pool: self.truth, bias: 0.0, ..*self };
        // Independent of the draws in which the error is to be found.
        let answer = (DRAWS..2 * DRAWS).into_par_iter().all(|number| !right.finds(samples, number));
        known().insert((self.test, samples), answer);
        answer
    }

    fn counts(&self, samples: u64, grades: u64, found: u64) -> Counts {
        let pixels = u64::from(SIZE.0 * SIZE.1);
        Counts { grades, biased: found, unclear: grades - found, samples: grades * samples * pixels }
    }

    fn finds(&self, samples: u64, number: u64) -> bool {
        let draw = |pool: &Pool, bias: f64, part: u64| {
            let seed = batch_seed(self.seed ^ part, number);
            let seeds = (0..samples).map(|sample| batch_seed(seed, sample)).collect();
            pool.draw(&SampleRequest { seeds, first_sample: 0, samples: 1 }, bias)
        };
        let own = draw(self.pool, self.bias, 1);
        let smallest = if self.test == Test::Welch {
            let tiles: Vec<Region> = pyramid(SIZE.0, SIZE.1)
                .into_iter()
                .filter(|it| it.level == 3 && it.id.kind == RegionKind::Luminance)
                .collect();
            let right = draw(self.truth, 0.0, 2);
            let p = |tile: &Region| {
                welch(
                    &moments(&own, |image| mean_of(tile, image)),
                    &moments(&right, |image| mean_of(tile, image)),
                )
            };
            min_p_value(tiles.len(), tiles.iter().map(p).fold(1.0, f64::min))
        } else {
            let truth = self.truth.mean();
            let p = |pixel: usize| {
                z_test(
                    &moments(&own, |image| luminance(&image[pixel].map(f64::from))),
                    luminance(&truth[pixel]),
                )
            };
            min_p_value(truth.len(), (0..truth.len()).map(p).fold(1.0, f64::min))
        };
        smallest < self.level
    }
}

/// Mean of a tile of an image.
fn mean_of(tile: &Region, image: &[[f32; 3]]) -> f64 {
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
    let degrees_of_freedom =
        variance.powi(2) / (a.variance.powi(2) / (a.count - 1.0) + b.variance.powi(2) / (b.count - 1.0));
    let t = (a.mean - b.mean).abs() / variance.sqrt();
    StudentsT::new(0.0, 1.0, degrees_of_freedom).map_or(1.0, |distribution| 2.0 * distribution.sf(t))
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
        let (pool, known) = (Pool::of((0..4096).map(image).collect()), AlarmCache::default());
        for test in [Test::Welch, Test::Pixels] {
            let need = |bias| {
                Fixed { test, pool: &pool, bias, truth: &pool, level: 1e-6, seed: 1, known: &known }.need()
            };
            let (large, small) = (need(1.0), need(0.3));
            assert!(large.biased >= ENOUGH && small.biased >= ENOUGH, "{test:?}: {large:?} {small:?}");
            assert!(small.samples > 2 * large.samples, "{test:?}: {large:?} {small:?}");
            let none =
                Fixed { test, pool: &pool, bias: 0.0, truth: &pool, level: 1e-6, seed: 1, known: &known }
                    .alarms(256, 20);
            assert_eq!(none.biased, 0, "{test:?}: nominally 2e-5");
        }
    }

    #[test]
    fn a_test_with_false_alarms_finds_nothing() {
        // One sample in ten thousand is ten thousand times as bright: a z-test knows neither mean nor variance.
        let image = |number: u64| {
            let mut random = arty::sampler::Sampler::new(number, (0, 0), 0);
            (0..256)
                .map(|_| [if random.next_1d() < 1e-4 { 1e4 } else { 0.1 * random.next_1d() }; 3])
                .collect()
        };
        let (pool, known) = (Pool::of((0..4096).map(image).collect()), AlarmCache::default());
        let fixed = |bias| Fixed {
            test: Test::Pixels,
            pool: &pool,
            bias,
            truth: &pool,
            level: 1e-6,
            seed: 1,
            known: &known,
        };
        assert_eq!(fixed(0.0).alarms(MIN_SAMPLES, 20).biased, 20);
        assert_eq!(fixed(0.0).found(MIN_SAMPLES), DRAWS);
        assert!(!fixed(0.05).has_no_false_alarm(MIN_SAMPLES));
        assert!(fixed(0.05).need().samples > 64 * MIN_SAMPLES * u64::from(SIZE.0 * SIZE.1));
    }
}
