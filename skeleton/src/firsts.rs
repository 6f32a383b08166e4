//! Which of many things are the same: sorting beats a hash table, which waits for memory at each step.

use std::hash::{BuildHasher, Hash};

use foldhash::fast::FixedState;
use rayon::prelude::*;

/// Fewer things than this are not worth another thread.
pub(crate) const LEAST: usize = 1 << 12;

/// For each of `count` things the number of the first that has the same key.
pub(crate) fn firsts<K: Hash + Eq>(count: usize, key: impl Fn(usize) -> K + Sync) -> Vec<u32> {
    // Hash above number: those with the same hash stand together, in their order.
    let hasher = FixedState::default();
    let entry = |number: usize| hasher.hash_one(key(number)) & !u64::from(u32::MAX) | number as u64;
    let mut entries: Vec<u64> = (0..count).into_par_iter().with_min_len(LEAST).map(entry).collect();
    entries.par_sort_unstable();
    let number = |entry: u64| (entry & u64::from(u32::MAX)) as usize;
    let mut firsts = vec![0; count];
    for alike in entries.chunk_by(|a, b| a >> 32 == b >> 32) {
        for (position, &entry) in alike.iter().enumerate() {
            // Mostly the first one, if any. Of others only the hash is the same.
            let same = |&&earlier: &&u64| key(number(earlier)) == key(number(entry));
            let earlier = alike[..position].iter().find(same).unwrap_or(&entry);
            firsts[number(entry)] = number(*earlier) as u32;
        }
    }
    firsts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_thing_knows_the_first_of_its_kind() {
        assert_eq!(firsts(6, |number| [3, 1, 3, 3, 2, 1][number]), [0, 1, 0, 0, 4, 1]);
        assert_eq!(firsts(0, |_| 0), []);
        // So many different keys that 32 bits of some hashes are the same: of 2^19, in 2^37 pairs, some 32.
        let count = 1 << 20;
        let found = firsts(count, |number| number / 2);
        assert!(found.iter().enumerate().all(|(number, &first)| first as usize == number / 2 * 2));
    }
}
