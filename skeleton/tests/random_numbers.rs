//! Random numbers are uniform, and independent between neighbouring streams.
//!
//! Nineteen χ² tests at 1e-6 each: a correct program fails with a probability below 2e-5 (seeds are fixed).

mod common;

use arty::sampler::{Sampler, batch_seed};
use common::statistics::uniformity;

const ALPHA: f64 = 1e-6;
const COUNT: u64 = 200_000;
const CELLS: usize = 32;

/// The nth number of a stream.
fn nth(mut sampler: Sampler, n: usize) -> f64 {
    f64::from((0..=n).map(|_| sampler.next_1d()).last().expect("at least one number"))
}

fn assert_uniform(what: &str, pairs: impl Iterator<Item = (f64, f64)>) {
    let p = uniformity(CELLS, pairs);
    assert!(p > ALPHA, "{what}: {p}");
}

#[test]
fn a_stream_is_uniform_and_its_consecutive_numbers_are_independent() {
    let mut sampler = Sampler::new(1, (2, 3), 4);
    assert_uniform("pairs", (0..COUNT).map(|_| sampler.next_2d()).map(|(u, v)| (u.into(), v.into())));
    for lag in [1, 2, 7] {
        let mut sampler = Sampler::new(lag as u64, (0, 0), 0);
        let numbers: Vec<f64> = (0..2 * COUNT).map(|_| sampler.next_1d().into()).collect();
        // Disjoint pairs.
        let pairs =
            numbers.chunks_exact(2 * lag).flat_map(|chunk| (0..lag).map(|i| (chunk[i], chunk[i + lag])));
        assert_uniform(&format!("lag {lag}"), pairs);
    }
}

#[test]
fn neighbouring_samples_pixels_seeds_and_batches_are_independent() {
    type Stream = fn(u64) -> Sampler;
    let streams: [(&str, Stream); 5] = [
        ("samples", |i| Sampler::new(7, (5, 6), i)),
        ("columns", |i| Sampler::new(7, (i as u32, 6), 0)),
        ("rows", |i| Sampler::new(7, (5, i as u32), 0)),
        ("seeds", |i| Sampler::new(i, (5, 6), 0)),
        ("batches", |i| Sampler::new(batch_seed(7, i), (5, 6), 0)),
    ];
    for (what, stream) in streams {
        // The same number of two neighbouring streams, and two numbers of one stream.
        for n in [0, 3] {
            let pairs = (0..COUNT / 2).map(|i| (nth(stream(2 * i), n), nth(stream(2 * i + 1), n)));
            assert_uniform(&format!("{what}, number {n}"), pairs);
        }
        assert_uniform(what, (0..COUNT).map(|i| (nth(stream(i), 0), nth(stream(i), 1))));
    }
}

#[test]
fn numbers_are_below_one_and_cover_the_interval() {
    let mut sampler = Sampler::new(3, (0, 0), 0);
    let (mut low, mut high) = (1.0f32, 0.0f32);
    for _ in 0..2_000_000 {
        let number = sampler.next_1d();
        assert!((0.0..1.0).contains(&number));
        (low, high) = (low.min(number), high.max(number));
    }
    // The probability of missing a hundred-thousandth at an end is e^-20.
    assert!(low < 1e-5 && high > 1.0 - 1e-5);
}

/// The tests above can fail.
#[test]
fn shared_streams_are_rejected() {
    // One stream for each x ^ y: pixels on a diagonal share numbers.
    let stream = |x: u32, y: u32| Sampler::new(1, (x ^ y, 0), 0);
    let pairs = (0..COUNT as u32).map(|i| (nth(stream(i, i + 1), 0), nth(stream(i + 1, i), 0)));
    assert!(uniformity(CELLS, pairs) < 1e-12);
}
