//! Numbers that are independent of all others.

use super::{GOLDEN, mix};

/// PCG-XSH-RR 64/32 (O'Neill, "PCG: A Family of Simple Fast Space-Efficient Statistically Good Algorithms for Random
/// Number Generation", HMC-CS-2014-0905).
#[derive(Clone, Debug)]
pub(super) struct Independent {
    state: u64,
    increment: u64,
}

impl Independent {
    /// The stream of a sample. `key` belongs to its seed and pixel.
    #[inline]
    pub(super) fn new(key: u64, sample: u64) -> Self {
        let state = mix(key.wrapping_add(sample.wrapping_mul(GOLDEN)));
        // The increment separates streams whose states happen to coincide; PCG requires it to be odd.
        Self { state, increment: mix(state ^ key) | 1 }
    }

    /// The next number.
    #[inline]
    pub(super) fn draw(&mut self) -> f32 {
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

#[cfg(test)]
mod tests {
    use super::super::key;
    use super::*;

    #[test]
    fn the_generator_reproduces_the_published_numbers() {
        // The demonstration of the PCG library: pcg32_srandom(42, 54).
        let mut numbers = Independent { state: 0, increment: 54 << 1 | 1 };
        numbers.next_u32();
        numbers.state = numbers.state.wrapping_add(42);
        numbers.next_u32();
        let numbers: Vec<u32> = (0..6).map(|_| numbers.next_u32()).collect();
        assert_eq!(numbers, [0xa15c_02b7, 0x7b47_f409, 0xba1d_3330, 0x83d2_f293, 0xbfa4_784b, 0xcbed_606e]);
    }

    #[test]
    fn numbers_are_less_than_one() {
        let largest = (u32::MAX >> 8) as f32 * (1.0 / 16_777_216.0);
        assert!(largest < 1.0);
    }

    #[test]
    fn each_seed_pixel_and_sample_has_its_own_stream() {
        let mut seen = std::collections::HashSet::new();
        for seed in 0..8 {
            for x in 0..8 {
                for y in 0..8 {
                    for sample in 0..8 {
                        let mut stream = Independent::new(key(seed, (x, y)), sample);
                        seen.insert((stream.next_u32(), stream.state));
                    }
                }
            }
        }
        assert_eq!(seen.len(), 8 * 8 * 8 * 8);
    }
}
