//! Random numbers: one stream for each (seed, pixel, sample).

mod independent;
mod sobol;

use crate::probe::{self, Call};

use independent::Independent;
use sobol::Sobol;

/// The random numbers of one path.
///
/// Each triple (seed, pixel, sample) has its own stream, which depends on nothing else. So any path can be replayed,
/// images do not depend on the number of threads or the order of the pixels, and renderings with different seeds are
/// independent.
#[derive(Clone, Debug)]
pub struct Sampler(Numbers);

#[derive(Clone, Debug)]
enum Numbers {
    Independent(Independent),
    Sobol(Sobol),
}

/// How the samples of one pixel relate to each other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
pub enum SamplerKind {
    /// Independent random numbers: the error falls with the square root of the number of samples.
    #[default]
    Independent,
    /// Owen-scrambled Sobol' points: the samples of a pixel complement each other, so that the error falls faster.
    Sobol,
}

impl SamplerKind {
    /// Its name on the command line and in metadata.
    pub fn name(self) -> &'static str {
        match self {
            Self::Independent => "independent",
            Self::Sobol => "sobol",
        }
    }
}

/// All streams of a rendering.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Streams {
    /// Renderings with different seeds are independent.
    pub seed: u64,
    /// How the samples of one pixel relate to each other.
    pub kind: SamplerKind,
}

impl Streams {
    /// Streams of independent numbers.
    pub fn independent(seed: u64) -> Self {
        Self { seed, kind: SamplerKind::Independent }
    }

    /// The stream of one sample of one pixel.
    #[inline]
    pub fn sampler(self, pixel: (u32, u32), sample: u64) -> Sampler {
        let key = key(self.seed, pixel);
        Sampler(match self.kind {
            SamplerKind::Independent => Numbers::Independent(Independent::new(key, sample)),
            SamplerKind::Sobol => Numbers::Sobol(Sobol::new(key, sample)),
        })
    }
}

impl Sampler {
    /// The stream of independent numbers of one sample of one pixel.
    #[inline]
    pub fn new(seed: u64, pixel: (u32, u32), sample: u64) -> Self {
        Streams::independent(seed).sampler(pixel, sample)
    }

    /// The next random number: uniform in [0, 1).
    #[inline]
    pub fn next_1d(&mut self) -> f32 {
        let number = probe::stratified(self.draw());
        probe::record(|| recorded_1d(number));
        number
    }

    /// The next two random numbers, independent of each other and uniform in [0, 1).
    #[inline]
    pub fn next_2d(&mut self) -> (f32, f32) {
        let (first, second) = self.draw_2d();
        let numbers = (probe::stratified(first), probe::stratified(second));
        probe::record(|| recorded_2d(numbers));
        numbers
    }

    /// Two random numbers for the framework itself, as in `Bsdf::sample` and `Light::sample_direct`.
    #[inline]
    pub(crate) fn draw_2d(&mut self) -> (f32, f32) {
        match &mut self.0 {
            Numbers::Independent(numbers) => (numbers.draw(), numbers.draw()),
            Numbers::Sobol(numbers) => numbers.draw_2d(),
        }
    }

    /// One random number for the framework itself.
    #[inline]
    pub(crate) fn draw(&mut self) -> f32 {
        match &mut self.0 {
            Numbers::Independent(numbers) => numbers.draw(),
            Numbers::Sobol(numbers) => numbers.draw(),
        }
    }
}

/// A number for each seed and pixel.
#[inline]
fn key(seed: u64, (x, y): (u32, u32)) -> u64 {
    let pixel = u64::from(y) << 32 | u64::from(x);
    mix(mix(seed.wrapping_add(GOLDEN)).wrapping_add(pixel.wrapping_mul(GOLDEN)))
}

/// The seed of one of many independent batches of a rendering with the given `seed`.
pub fn batch_seed(seed: u64, batch: u64) -> u64 {
    mix(mix(seed ^ GOLDEN).wrapping_add(batch.wrapping_mul(GOLDEN)))
}

/// 2⁶⁴ divided by the golden ratio, whose multiples are evenly distributed.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// The finaliser of SplitMix64 (Steele, Lea, Flood, OOPSLA 2014; constants by D. Stafford, variant 13): every bit
/// of the result depends on every bit of the argument.
#[inline]
fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

fn recorded_1d(number: f32) -> Call {
    Call::new("Sampler::next_1d").got("number", number)
}

fn recorded_2d(numbers: (f32, f32)) -> Call {
    Call::new("Sampler::next_2d").got("numbers", numbers)
}
