//! Means of pixels by quadrature.

use arty::ray::Ray;
use arty::scene::Scene;
use verdict::check::WhyNot;

use crate::reference::SIZE;

/// Mean and standard error of the quadrature of each pixel, by channel.
pub(in crate::checks) struct Pixels {
    pub(in crate::checks) mean: Vec<[f64; 3]>,
    pub(in crate::checks) error: Vec<[f64; 3]>,
}

/// Rays per pixel of the quadrature.
pub(super) const RAYS: u32 = 192;

/// The plastic number g, the root of g³ = g + 1: multiples of 1/g and 1/g² fill the square evenly (Roberts 2018, "The
/// Unreasonable Effectiveness of Quasirandom Sequences").
const PLASTIC: f64 = 1.324_717_957_244_746;

impl Pixels {
    /// Integrates radiance over each pixel.
    ///
    /// The error is that of evenly distributed points in a square with an edge through it: it falls as N^(−3/4) times
    /// the standard deviation of the values, where random points would give N^(−1/2) (Mitchell, "Consequences of
    /// Stratified Sampling in Graphics", SIGGRAPH 1996).
    pub(in crate::checks) fn integrate(
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

/// Maximum over each pixel and its neighbours: an edge may cut off a corner of the pixel that no ray hits.
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
