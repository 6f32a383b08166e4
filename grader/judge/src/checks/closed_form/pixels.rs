//! Means over pixels, by quadrature.

use arty::ray::Ray;
use arty::scene::Scene;
use verdict::check::WhyNot;

use crate::reference::SIZE;

/// The mean of each pixel's channels, and how well quadrature knows it.
pub(super) struct Pixels {
    pub(super) mean: Vec<[f64; 3]>,
    pub(super) error: Vec<[f64; 3]>,
}

/// Rays for each pixel, where their mean is wanted.
pub(super) const RAYS: u32 = 192;

/// The plastic number, the root of x³ = x + 1: multiples of 1/g and 1/g² fill the square evenly (Roberts 2018, "The
/// Unreasonable Effectiveness of Quasirandom Sequences").
const PLASTIC: f64 = 1.324_717_957_244_746;

impl Pixels {
    /// Integrates the radiance that comes along rays over each pixel.
    ///
    /// The error is that of points that are spread evenly over a square with an edge through it: it falls as N^(−3/4)
    /// times the deviation between them, where that of random ones falls as N^(−1/2) (Mitchell, "Consequences of
    /// Stratified Sampling in Graphics", SIGGRAPH 1996).
    pub(super) fn integrate(
        scene: &Scene,
        rays: u32,
        mut radiance: impl FnMut(&Ray) -> Result<[f64; 3], WhyNot>,
    ) -> Result<Self, WhyNot> {
        let camera = scene.camera(SIZE.0, SIZE.1);
        let count = (SIZE.0 * SIZE.1) as usize;
        let mut pixels = Self { mean: Vec::with_capacity(count), error: Vec::with_capacity(count) };
        for y in 0..SIZE.1 {
            for x in 0..SIZE.0 {
                let (mut sum, mut squares) = ([0.0; 3], [0.0; 3]);
                for i in 0..rays {
                    let place = |step: f64| ((0.5 + f64::from(i) * step) % 1.0) as f32;
                    let value = radiance(&camera.ray(x, y, (place(1.0 / PLASTIC), place(PLASTIC.powi(-2)))))?;
                    for channel in 0..3 {
                        sum[channel] += value[channel];
                        squares[channel] += value[channel] * value[channel];
                    }
                }
                let count = f64::from(rays);
                let mean = sum.map(|sum| sum / count);
                pixels.mean.push(mean);
                pixels.error.push(std::array::from_fn(|channel| {
                    let variance = (squares[channel] / count - mean[channel] * mean[channel]).max(0.0);
                    variance.sqrt() * count.powf(-0.75)
                }));
            }
        }
        pixels.error = widened(&pixels.error);
        Ok(pixels)
    }
}

/// For each pixel the largest value of it and its neighbours: an edge may cut off a corner that no ray has found.
fn widened(errors: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let (width, height) = (SIZE.0 as usize, SIZE.1 as usize);
    let around = |place: usize, size: usize| place.saturating_sub(1)..(place + 2).min(size);
    let largest = |x: usize, y: usize, channel: usize| {
        let neighbours = around(y, height).flat_map(|row| around(x, width).map(move |column| (row, column)));
        neighbours.map(|(row, column)| errors[row * width + column][channel]).fold(0.0, f64::max)
    };
    (0..width * height)
        .map(|pixel| std::array::from_fn(|channel| largest(pixel % width, pixel / width, channel)))
        .collect()
}
