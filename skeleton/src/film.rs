//! Accumulation of samples.

use std::panic::Location;

use crate::math::{Rgb, first_non_finite_sum};

/// For each pixel the number, the sum and the sum of squares of its samples, in double precision.
///
/// NaN and infinite samples count as black. They are reported in [`anomalies`](Self::anomalies), as are negative samples,
/// which are summed unchanged.
#[derive(Clone, Debug)]
pub struct Film {
    width: u32,
    height: u32,
    pixels: Vec<Pixel>,
    anomalies: Anomalies,
}

/// Accumulated samples of one pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pixel {
    /// Number of samples.
    pub count: u64,
    /// Sum of the samples, per channel.
    pub sum: [f64; 3],
    /// Sum of their squares, per channel.
    pub sum_of_squares: [f64; 3],
}

/// Samples that no correct estimator returns: NaN, infinite or negative.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Anomalies {
    /// Number of samples with a NaN or infinite channel.
    pub non_finite: u64,
    /// Number of finite samples with a negative channel.
    pub negative: u64,
    /// The first [`KEPT`](Self::KEPT) anomalies, ordered by sample number, row and column.
    pub first: Vec<Anomaly>,
}

/// A sample that no correct estimator returns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Anomaly {
    /// Pixel column, from the left.
    pub x: u32,
    /// Pixel row, from the top.
    pub y: u32,
    /// Sample number, the argument of [`Sampler::new`](crate::sampler::Sampler::new) to replay its path.
    pub sample: u64,
    /// The value of the sample.
    pub value: Rgb,
    /// The addition of colours after which it was NaN or infinite; `None` if it is finite, or no sum made it so.
    pub sum: Option<&'static Location<'static>>,
}

impl Film {
    /// A black film.
    pub fn new(width: u32, height: u32) -> Self {
        let pixels = vec![Pixel::default(); width as usize * height as usize];
        Self { width, height, pixels, anomalies: Anomalies::default() }
    }

    /// Width in pixels.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Height in pixels.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The pixels, row by row from the top.
    pub fn pixels(&self) -> &[Pixel] {
        &self.pixels
    }

    /// The rows, for parallel iteration.
    pub(crate) fn rows_mut(&mut self) -> impl rayon::iter::IndexedParallelIterator<Item = &mut [Pixel]> {
        use rayon::slice::ParallelSliceMut;
        // A film of width 0 has no rows, but the length of chunks must not be 0.
        self.pixels.par_chunks_mut((self.width as usize).max(1))
    }

    /// Minimum number of samples over all pixels. All are equal unless rendering was interrupted.
    pub fn samples(&self) -> u64 {
        self.pixels.iter().map(|pixel| pixel.count).min().unwrap_or(0)
    }

    /// NaN, infinite and negative samples.
    pub fn anomalies(&self) -> &Anomalies {
        &self.anomalies
    }

    pub(crate) fn anomalies_mut(&mut self) -> &mut Anomalies {
        &mut self.anomalies
    }
}

impl Pixel {
    /// Adds a sample. Returns false if it is not finite: then it counts as black.
    #[inline]
    pub(crate) fn add(&mut self, sample: Rgb) -> bool {
        self.count += 1;
        if !sample.is_finite() {
            return false;
        }
        for (channel, value) in sample.to_array().into_iter().enumerate() {
            let value = f64::from(value);
            self.sum[channel] += value;
            self.sum_of_squares[channel] += value * value;
        }
        true
    }

    /// Mean of the samples: the estimate of the pixel's radiance. Black without samples.
    pub fn mean(&self) -> Rgb {
        let count = self.count.max(1) as f64;
        Rgb::from(self.sum.map(|sum| (sum / count) as f32))
    }

    /// Unbiased estimate of the variance of a sample, per channel; 0 for fewer than two samples.
    pub fn sample_variance(&self) -> [f64; 3] {
        if self.count < 2 {
            return [0.0; 3];
        }
        let count = self.count as f64;
        std::array::from_fn(|channel| {
            let mean = self.sum[channel] / count;
            ((self.sum_of_squares[channel] / count - mean * mean) * count / (count - 1.0)).max(0.0)
        })
    }

    /// Variance of the mean: the variance of a sample divided by the number of samples.
    pub fn variance_of_mean(&self) -> Rgb {
        let count = self.count.max(1) as f64;
        Rgb::from(self.sample_variance().map(|variance| (variance / count) as f32))
    }
}

impl Anomalies {
    /// Maximum length of [`first`](Self::first).
    pub const KEPT: usize = 16;

    /// True if there are no anomalies.
    pub fn is_empty(&self) -> bool {
        self.non_finite == 0 && self.negative == 0
    }

    /// Counts and keeps a sample if it is an anomaly.
    #[inline]
    pub(crate) fn inspect(&mut self, x: u32, y: u32, sample: u64, value: Rgb) {
        if value.is_finite() && value.min_channel() >= 0.0 {
            return;
        }
        if value.is_finite() {
            self.negative += 1;
        } else {
            self.non_finite += 1;
        }
        let sum = if value.is_finite() { None } else { first_non_finite_sum() };
        self.keep(Anomaly { x, y, sample, value, sum });
    }

    /// Keeps an anomaly if it is among the first, in whatever order they are reported.
    fn keep(&mut self, anomaly: Anomaly) {
        let order = |anomaly: &Anomaly| (anomaly.sample, anomaly.y, anomaly.x);
        let place = self.first.partition_point(|other| order(other) < order(&anomaly));
        if place < Self::KEPT {
            self.first.insert(place, anomaly);
            self.first.truncate(Self::KEPT);
        }
    }

    /// Adds the anomalies of other pixels.
    pub(crate) fn merge(&mut self, other: Self) {
        self.non_finite += other.non_finite;
        self.negative += other.negative;
        for anomaly in other.first {
            self.keep(anomaly);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mean_and_variance_match_the_samples() {
        let mut pixel = Pixel::default();
        for value in [1.0, 2.0, 3.0, 6.0] {
            assert!(pixel.add(Rgb::new(value, 10.0 * value, 0.5)));
        }
        assert_eq!(pixel.mean(), Rgb::new(3.0, 30.0, 0.5));
        let [r, g, b] = pixel.sample_variance();
        assert!((r - 14.0 / 3.0).abs() < 1e-12 && (g - 1400.0 / 3.0).abs() < 1e-9 && b == 0.0);
        assert!((f64::from(pixel.variance_of_mean().r) - 14.0 / 12.0).abs() < 1e-6);
    }

    #[test]
    fn non_finite_and_negative_samples_are_counted_and_located() {
        let mut pixel = Pixel::default();
        let mut anomalies = Anomalies::default();
        for (sample, value) in [1.0, f32::NAN, -2.0, f32::INFINITY].into_iter().enumerate() {
            anomalies.inspect(3, 4, sample as u64, Rgb::gray(value));
            pixel.add(Rgb::gray(value));
        }
        assert_eq!((anomalies.non_finite, anomalies.negative), (2, 1));
        assert_eq!(anomalies.first.iter().map(|anomaly| anomaly.sample).collect::<Vec<_>>(), [1, 2, 3]);
        assert_eq!(pixel.count, 4, "they count as samples");
        assert_eq!(pixel.mean(), Rgb::gray(-0.25));
    }
}
