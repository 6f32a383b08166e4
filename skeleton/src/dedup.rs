//! Deduplication by sorting hashes, which is faster than a hash table: a table waits for memory at each step.

use std::hash::{BuildHasher, Hash};

use foldhash::fast::FixedState;
use rayon::prelude::*;

/// Minimum number of items that are worth a thread of their own.
pub(crate) const MIN_PER_THREAD: usize = 1 << 12;

/// For each item the index of the first one with an equal key. `key` maps the index of an item, below `count`, to its
/// key.
pub(crate) fn dedup<K: Hash + Eq>(count: usize, key: impl Fn(usize) -> K + Sync) -> Vec<u32> {
    // The upper half of an entry is its hash, the lower half its index: equal hashes stay together, in order.
    let hasher = FixedState::default();
    let entry = |index: usize| hasher.hash_one(key(index)) & !u64::from(u32::MAX) | index as u64;
    let mut entries: Vec<u64> = (0..count).into_par_iter().with_min_len(MIN_PER_THREAD).map(entry).collect();
    entries.par_sort_unstable();
    let index = |entry: u64| (entry & u64::from(u32::MAX)) as usize;
    let mut first = vec![0; count];
    for equal_hash in entries.chunk_by(|a, b| a >> 32 == b >> 32) {
        for (position, &entry) in equal_hash.iter().enumerate() {
            // Equal hashes do not imply equal keys, but collisions are rare: mostly the first entry matches.
            let same = |&&earlier: &&u64| key(index(earlier)) == key(index(entry));
            let earlier = equal_hash[..position].iter().find(same).unwrap_or(&entry);
            first[index(entry)] = index(*earlier) as u32;
        }
    }
    first
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_item_maps_to_the_first_one_with_an_equal_key() {
        assert_eq!(dedup(6, |index| [3, 1, 3, 3, 2, 1][index]), [0, 1, 0, 0, 4, 1]);
        assert!(dedup(0, |_| 0).is_empty());
        // Enough different keys for collisions of 32-bit hashes: 2^19 keys make 2^37 pairs, some 32 of which collide.
        let count = 1 << 20;
        let found = dedup(count, |index| index / 2);
        assert!(found.iter().enumerate().all(|(index, &first)| first as usize == index / 2 * 2));
    }
}
