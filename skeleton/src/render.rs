//! From an integrator to an image.

use std::sync::atomic::{AtomicBool, Ordering};

use rayon::iter::{IndexedParallelIterator, ParallelIterator};

use crate::camera::Camera;
use crate::film::{Anomalies, Film, Pixel};
use crate::integrator::Integrator;
use crate::math::Rgb;
use crate::sampler::Sampler;
use crate::scene::Scene;

/// One sample of one pixel: a random place in the pixel's square, and the radiance seen there.
///
/// This is all that an image is made of, so any path can be computed again by its (seed, pixel, sample).
#[inline]
pub fn sample_pixel(
    integrator: &dyn Integrator,
    scene: &Scene,
    camera: &Camera,
    seed: u64,
    (x, y): (u32, u32),
    sample: u64,
) -> Rgb {
    let mut sampler = Sampler::new(seed, (x, y), sample);
    let ray = camera.ray(x, y, sampler.draw_2d());
    integrator.radiance(scene, ray, &mut sampler)
}

/// Adds `samples` samples to each pixel of the film, using all threads of the current rayon pool.
///
/// The result depends on nothing but the arguments: the samples of a pixel are numbered on from those it has, and
/// are added in that order. When `stop` becomes true, rows that are not finished stay where they are.
pub fn render(
    integrator: &dyn Integrator,
    scene: &Scene,
    film: &mut Film,
    samples: u64,
    seed: u64,
    stop: &AtomicBool,
) {
    let camera = scene.camera(film.width(), film.height());
    let row = |(y, pixels): (usize, &mut [Pixel])| {
        let mut anomalies = Anomalies::default();
        for (x, pixel) in pixels.iter_mut().enumerate() {
            if stop.load(Ordering::Relaxed) {
                break;
            }
            let (x, y) = (x as u32, y as u32);
            for sample in pixel.count..pixel.count + samples {
                let value = sample_pixel(integrator, scene, &camera, seed, (x, y), sample);
                anomalies.inspect(x, y, sample, value);
                pixel.add(value);
            }
        }
        anomalies
    };
    let anomalies = film.rows_mut().enumerate().map(row).reduce(Anomalies::default, |mut all, some| {
        all.merge(some);
        all
    });
    film.anomalies_mut().merge(anomalies);
}
