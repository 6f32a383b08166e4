//! Random numbers: one stream for each (seed, pixel, sample).

use crate::probe::{self, Call};

/// The random numbers of one path.
///
/// Each triple (seed, pixel, sample) has its own stream, which depends on nothing else. So any path can be replayed,
/// images do not depend on the number of threads or the order of the pixels, and renderings with different seeds are
/// independent.
///
/// The generator is PCG-XSH-RR 64/32 (O'Neill, "PCG: A Family of Simple Fast Space-Efficient Statistically Good
/// Algorithms for Random Number Generation", HMC-CS-2014-0905).
#[derive(Clone, Debug)]
pub struct Sampler {
    state: u64,
    increment: u64,
}

impl Sampler {
    /// The stream of one sample of one pixel.
    #[inline]
    pub fn new(seed: u64, (x, y): (u32, u32), sample: u64) -> Self {
        let pixel = u64::from(y) << 32 | u64::from(x);
        let key = mix(mix(seed.wrapping_add(GOLDEN)).wrapping_add(pixel.wrapping_mul(GOLDEN)));
        let state = mix(key.wrapping_add(sample.wrapping_mul(GOLDEN)));
        // The increment separates streams whose states happen to coincide; PCG requires it to be odd.
        Self { state, increment: mix(state ^ key) | 1 }
    }

    /// The next random number: uniform in [0, 1), a multiple of 2⁻²⁴.
    #[inline]
    pub fn next_1d(&mut self) -> f32 {
        let number = self.own();
        probe::record(|| recorded_1d(number));
        number
    }

    /// The next two random numbers, independent and uniform in [0, 1).
    #[inline]
    pub fn next_2d(&mut self) -> (f32, f32) {
        let numbers = (self.own(), self.own());
        probe::record(|| recorded_2d(numbers));
        numbers
    }

    /// A random number for an integrator.
    #[inline]
    fn own(&mut self) -> f32 {
        probe::stratified(self.draw())
    }

    /// Two random numbers for the framework itself, as in `Bsdf::sample` and `Light::sample_direct`.
    #[inline]
    pub(crate) fn draw_2d(&mut self) -> (f32, f32) {
        (self.draw(), self.draw())
    }

    /// One random number for the framework itself.
    #[inline]
    pub(crate) fn draw(&mut self) -> f32 {
        // The upper 24 bits, as many as the significand of an f32 has: rounding cannot make it 1.
        (self.next_u32() >> 8) as f32 * (1.0 / 16_777_216.0)
    }

    #[inline]
    fn next_u32(&mut self) -> u32 {
        let old = self.state;
        self.state = old.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(self.increment);
        let shifted = (((old >> 18) ^ old) >> 27) as u32;
        shifted.rotate_right((old >> 59) as u32)
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_generator_reproduces_the_published_numbers() {
        // The demonstration of the PCG library: pcg32_srandom(42, 54).
        let mut sampler = Sampler { state: 0, increment: 54 << 1 | 1 };
        sampler.next_u32();
        sampler.state = sampler.state.wrapping_add(42);
        sampler.next_u32();
        let numbers: Vec<u32> = (0..6).map(|_| sampler.next_u32()).collect();
        assert_eq!(numbers, [0xa15c_02b7, 0x7b47_f409, 0xba1d_3330, 0x83d2_f293, 0xbfa4_784b, 0xcbed_606e]);
    }

    #[test]
    fn numbers_are_less_than_one() {
        let largest = (u32::MAX >> 8) as f32 * (1.0 / 16_777_216.0);
        assert!(largest < 1.0);
    }

    #[test]
    fn each_seed_pixel_and_sample_has_its_own_stream() {
        let first = |seed, pixel, sample| Sampler::new(seed, pixel, sample).next_u32();
        let mut seen = std::collections::HashSet::new();
        for seed in 0..8 {
            for x in 0..8 {
                for y in 0..8 {
                    for sample in 0..8 {
                        seen.insert((first(seed, (x, y), sample), Sampler::new(seed, (x, y), sample).state));
                    }
                }
            }
        }
        assert_eq!(seen.len(), 8 * 8 * 8 * 8);
    }
}
