//! Rendering: from an integrator to a film.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::iter::{IndexedParallelIterator, ParallelIterator};

use crate::camera::Camera;
use crate::film::{Anomalies, Film, Pixel};
use crate::integrator::Integrator;
use crate::math::{Rgb, forget_sums};
use crate::sampler::Streams;
use crate::scene::Scene;

/// One sample of one pixel: the radiance along a ray through a random position in the pixel.
///
/// Images consist of nothing else, so any path can be replayed by its (seed, pixel, sample).
#[inline]
pub fn sample_pixel(
    integrator: &dyn Integrator,
    scene: &Scene,
    camera: &Camera,
    streams: Streams,
    (x, y): (u32, u32),
    sample: u64,
) -> Rgb {
    forget_sums();
    let mut sampler = streams.sampler((x, y), sample);
    let ray = camera.ray(x, y, sampler.draw_2d());
    integrator.radiance(scene, ray, &mut sampler)
}

/// Adds the samples with the given numbers to each pixel of the film, using all threads of the current rayon pool.
///
/// The result depends on the arguments only: each pixel adds its samples in order, on whichever thread. When `stop` becomes
/// true, pixels that have not been started are skipped.
pub fn render(
    integrator: &dyn Integrator,
    scene: &Scene,
    film: &mut Film,
    samples: Range<u64>,
    streams: Streams,
    stop: &AtomicBool,
) {
    let camera = scene.camera(film.width(), film.height());
    render_from(&camera, integrator, scene, film, samples, streams, stop);
}

/// [`render`] with another camera than the scene's, made for the size of the film.
pub fn render_from(
    camera: &Camera,
    integrator: &dyn Integrator,
    scene: &Scene,
    film: &mut Film,
    samples: Range<u64>,
    streams: Streams,
    stop: &AtomicBool,
) {
    let row = |(y, pixels): (usize, &mut [Pixel])| {
        let mut anomalies = Anomalies::default();
        for (x, pixel) in pixels.iter_mut().enumerate() {
            if stop.load(Ordering::Relaxed) {
                break;
            }
            let (x, y) = (x as u32, y as u32);
            for sample in samples.clone() {
                let value = sample_pixel(integrator, scene, camera, streams, (x, y), sample);
                anomalies.inspect(x, y, sample, value);
                pixel.add(value);
            }
        }
        anomalies
    };
    // Single rows balance the load between threads.
    let rows = film.rows_mut().enumerate().with_max_len(1);
    let anomalies = rows.map(row).reduce(Anomalies::default, |mut all, some| {
        all.merge(some);
        all
    });
    film.anomalies_mut().merge(anomalies);
}
