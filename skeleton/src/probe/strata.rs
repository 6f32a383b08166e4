//! Stratified random numbers.

use std::cell::Cell;

use super::Key;

/// Latin hypercube sampling of the integrator's own random numbers (not of those that the framework draws) over many paths:
/// the k-th numbers of all paths have exactly one value in each of `count` equal strata, in a different order for each k. So
/// the fraction of paths for which one number is below a threshold is exact to 1 / `count` (McKay, Beckman, Conover,
/// Technometrics 21(2), 1979).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Strata {
    /// Index of the path, less than `count`.
    pub path: u32,
    /// Number of paths: a power of two, at most 2²⁰.
    pub count: u32,
    /// Seed of the permutations.
    pub seed: u32,
    /// True if the last stratum is reduced to the largest number below 1, so that a decision with a probability close to
    /// 1 goes the other way once. This biases the numbers: it shows that there is a decision, not how often it goes
    /// which way.
    pub with_extreme: bool,
}

thread_local! {
    /// The strata of the current path of this thread, and the number of values drawn so far.
    static STRATA: Cell<Option<(Strata, u32)>> = const { Cell::new(None) };
}

/// Stratifies the integrator's own numbers on this thread from now on; `None` ends this.
pub fn set_strata(_: &Key, strata: Option<Strata>) {
    STRATA.set(strata.map(|strata| (strata, 0)));
}

/// Moves a number of the integrator's into its stratum, if strata are set.
#[inline]
pub(crate) fn stratified(number: f32) -> f32 {
    let Some((strata, taken)) = STRATA.get() else { return number };
    STRATA.set(Some((strata, taken + 1)));
    strata.place(taken, number)
}

/// The largest number below 1 that a sampler returns.
const BELOW_ONE: f32 = 1.0 - f32::EPSILON / 2.0;

impl Strata {
    fn place(&self, dimension: u32, number: f32) -> f32 {
        let stratum = self.stratum(dimension);
        if self.with_extreme && stratum + 1 == self.count {
            return BELOW_ONE;
        }
        // Rounding must not reach 1.
        ((stratum as f32 + number) / self.count as f32).min(BELOW_ONE)
    }

    /// A permutation of the paths, different for each dimension: odd factors and xor-shifts are invertible.
    fn stratum(&self, dimension: u32) -> u32 {
        let mask = self.count - 1;
        let key =
            (self.seed ^ dimension.wrapping_mul(0x9e37_79b9)).wrapping_mul(0x85eb_ca6b) ^ (self.seed >> 7);
        let half = self.count.trailing_zeros().div_ceil(2).max(1);
        let mut index = self.path;
        for round in 0..3u32 {
            let factor = key.rotate_left(11 * round) | 1;
            index = index.wrapping_mul(factor).wrapping_add(key >> (3 + round)) & mask;
            index ^= index >> half;
        }
        index & mask
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_stratum_has_one_path_in_a_different_order_per_dimension() {
        for count in [1, 2, 4, 64, 4096] {
            let order = |dimension: u32| -> Vec<u32> {
                (0..count)
                    .map(|path| Strata { path, count, seed: 7, with_extreme: false }.stratum(dimension))
                    .collect()
            };
            for dimension in 0..5 {
                let mut seen = order(dimension);
                seen.sort_unstable();
                assert!(seen.iter().copied().eq(0..count), "{count} strata, dimension {dimension}");
            }
            assert!(count < 64 || order(0) != order(1) && order(1) != order(2));
        }
    }

    #[test]
    fn one_path_has_the_extreme_number() {
        let place = |path| Strata { path, count: 64, seed: 7, with_extreme: true }.place(2, 0.5);
        assert_eq!((0..64).filter(|&path| place(path) == BELOW_ONE).count(), 1);
    }

    #[test]
    fn numbers_are_below_one_and_unchanged_without_strata() {
        let strata = Strata { path: 0, count: 1 << 20, seed: 3, with_extreme: false };
        for dimension in 0..1000 {
            let number = strata.place(dimension, 1.0 - f32::EPSILON / 2.0);
            assert!((0.0..1.0).contains(&number), "{number}");
        }
        set_strata(&Key(()), Some(strata));
        assert_ne!(stratified(0.5), 0.5);
        set_strata(&Key(()), None);
        assert_eq!(stratified(0.5), 0.5);
    }
}
