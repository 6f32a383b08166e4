//! Means over pixels, by quadrature.

use arty::ray::Ray;
use arty::scene::Scene;

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
    /// Integrates the radiance that comes along rays (an even number) over each pixel. How much the odd ones among the rays differ from
    /// the even ones tells how well: edges that cross a pixel show there.
    pub(super) fn integrate(
        scene: &Scene,
        rays: u32,
        mut radiance: impl FnMut(&Ray) -> Result<[f64; 3], String>,
    ) -> Result<Self, String> {
        let camera = scene.camera(SIZE.0, SIZE.1);
        let count = (SIZE.0 * SIZE.1) as usize;
        let mut pixels = Self { mean: Vec::with_capacity(count), error: Vec::with_capacity(count) };
        for y in 0..SIZE.1 {
            for x in 0..SIZE.0 {
                let mut halves = [[0.0; 3]; 2];
                for i in 0..rays {
                    let place = |step: f64| ((0.5 + f64::from(i) * step) % 1.0) as f32;
                    let value = radiance(&camera.ray(x, y, (place(1.0 / PLASTIC), place(PLASTIC.powi(-2)))))?;
                    let half = &mut halves[i as usize % 2];
                    (0..3).for_each(|channel| half[channel] += value[channel] * 2.0 / f64::from(rays));
                }
                let [a, b] = halves;
                pixels.mean.push(std::array::from_fn(|channel| 0.5 * (a[channel] + b[channel])));
                pixels.error.push(std::array::from_fn(|channel| 0.5 * (a[channel] - b[channel]).abs()));
            }
        }
        Ok(pixels)
    }
}
