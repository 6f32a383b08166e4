//! Numbers that fill the unit cube evenly over the samples of a pixel.

use sobol_burley::{NUM_DIMENSION_SETS_4D, sample_4d};

use super::mix;

/// A point of the Sobol' sequence, number by number: Owen scrambling, which makes each number uniform and pixels
/// independent of each other (Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020).
///
/// One stream must not be shared by numbers with different meaning: the n-th number of every sample of a pixel is the
/// same dimension, as long as paths ask for the same kinds of numbers in the same order.
#[derive(Clone, Debug)]
pub(super) struct Sobol {
    /// Point of the sequence, less than [`POINTS`].
    point: u32,
    /// Scrambling of the pixel.
    scramble: u64,
    /// Dimension of the next number.
    dimension: u32,
    /// The four dimensions that include the next one, unless it is the first of them.
    four: [f32; 4],
}

/// Number of points of a sequence. More samples begin another one, scrambled differently.
const POINTS: u64 = 1 << 16;

impl Sobol {
    /// The stream of a sample. `key` belongs to its seed and pixel.
    #[inline]
    pub(super) fn new(key: u64, sample: u64) -> Self {
        Self {
            point: (sample % POINTS) as u32,
            scramble: mix(key ^ mix(sample / POINTS)),
            dimension: 0,
            four: [0.0; 4],
        }
    }

    /// The next number.
    #[inline]
    pub(super) fn draw(&mut self) -> f32 {
        let place = (self.dimension % 4) as usize;
        if place == 0 {
            self.four = self.next_four();
        }
        self.dimension += 1;
        self.four[place]
    }

    /// The next two numbers: two dimensions that are even together.
    #[inline]
    pub(super) fn draw_2d(&mut self) -> (f32, f32) {
        // Not the last of four dimensions and the first of the next.
        self.dimension += self.dimension % 2;
        (self.draw(), self.draw())
    }

    /// Beyond the dimensions that are tabulated, the sequence is used again, scrambled differently.
    #[inline]
    fn next_four(&self) -> [f32; 4] {
        let set = self.dimension / 4;
        let (round, set) = (set / NUM_DIMENSION_SETS_4D, set % NUM_DIMENSION_SETS_4D);
        let scramble = if round == 0 { self.scramble } else { mix(self.scramble.wrapping_add(round.into())) };
        sample_4d(self.point, set, (scramble >> 32) as u32)
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::super::key;
    use super::*;

    fn stream(seed: u64, sample: u64) -> Sobol {
        Sobol::new(key(seed, (3, 4)), sample)
    }

    /// Columns and rows of 256 cells of equal area.
    fn cells() -> impl Iterator<Item = (u32, u32)> {
        (0..=8).map(|power| (1 << power, 256 >> power))
    }

    /// The first two dimensions are a (0, 2)-sequence: each cell holds one of the first 256 points.
    #[test]
    fn the_position_in_the_pixel_is_stratified_in_two_dimensions() {
        let points: Vec<(f32, f32)> = (0..256).map(|sample| stream(1, sample).draw_2d()).collect();
        for (columns, rows) in cells() {
            let cell = |&(x, y): &(f32, f32)| ((x * columns as f32) as u32, (y * rows as f32) as u32);
            let seen: HashSet<(u32, u32)> = points.iter().map(cell).collect();
            assert_eq!(seen.len(), 256, "{columns} columns");
        }
    }

    #[test]
    fn each_number_is_stratified() {
        for before in [0, 1, 2, 3, 17, 300] {
            let number = |sample| {
                let mut stream = stream(1, sample);
                (0..=before).map(|_| stream.draw()).last().expect("at least one")
            };
            let seen: HashSet<u32> = (0..256).map(|sample| (number(sample) * 256.0) as u32).collect();
            assert_eq!(seen.len(), 256, "after {before} numbers");
        }
    }

    #[test]
    fn numbers_are_uniform_over_seeds() {
        // χ² of 64 cells with 63 degrees of freedom: above 127 with a probability of 3e-6 per number.
        for (sample, number) in [(0, 0), (1, 3), (77, 20), (POINTS, 2), (0, 300)] {
            let mut cells = [0.0; 64];
            for seed in 0..64_000 {
                let mut stream = stream(seed, sample);
                let drawn = (0..=number).map(|_| stream.draw()).last().expect("at least one");
                assert!((0.0..1.0).contains(&drawn));
                cells[(drawn * 64.0) as usize] += 1.0;
            }
            let chi2: f64 = cells.iter().map(|count: &f64| (count - 1000.0).powi(2) / 1000.0).sum();
            assert!(chi2 < 127.0, "sample {sample}, number {number}: {chi2}");
        }
    }

    /// The error of a smooth integral over ten numbers, which falls with the square root of the number of points if they
    /// are independent. The ratio of two errors of 100 sequences each varies by a tenth.
    #[test]
    fn the_error_of_a_mean_falls_faster_than_with_independent_numbers() {
        let error = |points: u64| {
            let mean = |seed| {
                let value = |sample| {
                    let mut stream = stream(seed, sample);
                    (0..10).map(|number| (stream.draw() - 0.5) / (number as f32 + 1.0)).sum::<f32>().exp()
                };
                (0..points).map(value).map(f64::from).sum::<f64>() / points as f64
            };
            // ∫ exp(a (x − ½)) dx = sinh(a/2) / (a/2)
            let exact: f64 = (1..=10).map(|number| 0.5 / f64::from(number)).map(|a| a.sinh() / a).product();
            ((0..100).map(|seed| (mean(seed) - exact).powi(2)).sum::<f64>() / 100.0).sqrt()
        };
        let ratio = error(16) / error(256);
        assert!(ratio > 8.0, "16 times as many points, an error divided by {ratio}, and by 4 if independent");
    }

    #[test]
    fn another_sequence_begins_where_points_or_dimensions_end() {
        let numbers = |sample| {
            let mut stream = stream(1, sample);
            (0..4 * NUM_DIMENSION_SETS_4D as usize + 4).map(|_| stream.draw()).collect::<Vec<_>>()
        };
        let (first, later) = (numbers(5), numbers(POINTS + 5));
        assert!(first.iter().zip(&later).all(|(a, b)| a != b));
        assert_ne!(first[..4], first[first.len() - 4..]);
    }
}
