//! What fuzzing has found stays mended: the corpora of `grader/fuzz` are read again, as they are and damaged.

#[allow(unreachable_pub, reason = "it is a library of its own as well")]
#[path = "../fuzz/src/targets.rs"]
mod targets;

use std::path::{Path, PathBuf};

/// Number of damaged variants of each input. Raise it with `FUZZ_ROUNDS`, for a machine without nightly Rust.
fn rounds() -> u64 {
    std::env::var("FUZZ_ROUNDS").ok().and_then(|text| text.parse().ok()).unwrap_or(20)
}

/// The inputs of a target, in the order of their names.
fn corpus(name: &str) -> Vec<(PathBuf, Vec<u8>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus").join(name);
    let files = std::fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut paths: Vec<PathBuf> = files.map(|file| file.expect("it can be listed").path()).collect();
    paths.sort();
    assert!(!paths.is_empty(), "{} is empty", folder.display());
    paths.into_iter().map(|path| (path.clone(), std::fs::read(path).expect("it can be read"))).collect()
}

#[test]
fn no_input_of_the_corpora_panics() {
    for (name, target) in targets::TARGETS {
        for (path, bytes) in corpus(name) {
            let outcome = std::panic::catch_unwind(|| target(&bytes));
            assert!(outcome.is_ok(), "{}", path.display());
        }
    }
}

#[test]
fn no_damaged_input_panics() {
    for (name, target) in targets::TARGETS {
        let inputs = corpus(name);
        for (index, (path, bytes)) in inputs.iter().enumerate() {
            let (_, other) = &inputs[(index + 1) % inputs.len()];
            for round in 0..rounds() {
                let damaged = damage(bytes, other, round);
                let outcome = std::panic::catch_unwind(|| target(&damaged));
                assert!(outcome.is_ok(), "{}, round {round}: {damaged:?}", path.display());
            }
        }
    }
}

/// An input with a few faults, the same in each run: other bytes, numbers at their limits, parts that are cut, doubled or
/// of another input.
fn damage(bytes: &[u8], other: &[u8], round: u64) -> Vec<u8> {
    const NUMBERS: [u32; 8] = [0, 1, 0x7f, 0x80, 0xffff, 0x7fff_ffff, 0x8000_0000, u32::MAX];
    let mut bytes = bytes.to_vec();
    let mut state = round.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ bytes.len() as u64;
    let mut next = |below: usize| {
        // splitmix64
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ (mixed >> 31)) % below.max(1) as u64) as usize
    };
    for _ in 0..=next(4) {
        let at = next(bytes.len());
        let end = (at + next(32)).min(bytes.len());
        match next(7) {
            0 => bytes.truncate(at),
            1 => drop(bytes.drain(at..end)),
            2 => {
                let part = bytes[at..end].to_vec();
                bytes.splice(at..at, part);
            }
            3 => {
                let from = next(other.len());
                let to = (from + next(64)).min(other.len());
                bytes.splice(at..end, other[from..to].iter().copied());
            }
            4 => {
                let number = NUMBERS[next(NUMBERS.len())].to_le_bytes();
                let end = (at + 1 + next(4)).min(bytes.len());
                bytes.splice(at.min(end)..end, number[..end.saturating_sub(at)].iter().copied());
            }
            _ => {
                if let Some(byte) = bytes.get_mut(at) {
                    *byte ^= 1 << next(8);
                }
            }
        }
    }
    bytes
}
