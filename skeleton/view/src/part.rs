//! A picture while it is refined.

use std::ops::Range;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use arty::camera::{Camera, CameraDescription};
use arty::cli::Algorithm;
use arty::film::{Anomalies, Film, Pixel};
use arty::image::Image;
use arty::integrator::Integrator;
use arty::math::Rgb;
use arty::render::render_from;
use arty::sampler::Streams;
use arty::scene::Scene;

use crate::reference::Reference;
use crate::schedule::{Pass, Progress, Speed};

/// A picture that is being rendered: one of a view, or of each half of a wipe.
pub struct Part {
    /// How it is rendered.
    pub algorithm: Algorithm,
    integrator: Box<dyn Integrator>,
    film: Film,
    /// The last coarse picture, as long as the film has no samples.
    coarse: Option<Film>,
    progress: Progress,
    time: Duration,
}

/// What all passes have in common.
pub struct Studio<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// The threads that render.
    pub pool: &'a rayon::ThreadPool,
    /// Seed of the random numbers.
    pub seed: u64,
}

/// A picture at some time of its refinement.
#[derive(Clone, Debug)]
pub struct Picture {
    /// How it was rendered.
    pub algorithm: Algorithm,
    /// The mean of each pixel. It has fewer pixels than the film while there are no samples for all.
    pub image: Image,
    /// Samples per pixel; 0 for a coarse picture.
    pub samples: u64,
    /// Time spent on it.
    pub time: Duration,
    /// Relative mean squared error against the reference; `None` without one, for a coarse picture, from another camera, and
    /// for properties of surfaces.
    pub relative_mse: Option<f64>,
    /// NaN, infinite and negative samples.
    pub anomalies: Anomalies,
}

impl Part {
    /// A picture without samples.
    pub fn new(algorithm: Algorithm, integrator: Box<dyn Integrator>, width: u32, height: u32) -> Self {
        let (film, progress) = (Film::new(width, height), Progress::default());
        Self { algorithm, integrator, film, coarse: None, progress, time: Duration::ZERO }
    }

    /// How far it is.
    pub fn progress(&self) -> Progress {
        self.progress
    }

    /// Time spent on it.
    pub fn time(&self) -> Duration {
        self.time
    }

    /// The samples so far.
    pub fn film(&self) -> &Film {
        &self.film
    }

    /// Renders a pass with the threads of the current pool, and measures its speed. When `stop` becomes true, some pixels
    /// have more samples than others, so that the picture should be dropped.
    pub fn render(
        &mut self,
        studio: &Studio<'_>,
        camera: &CameraDescription,
        pass: &Pass,
        speed: &mut Speed,
        stop: &AtomicBool,
    ) {
        let start = Instant::now();
        match pass {
            Pass::Coarse(divisor) => {
                let side = |length: u32| length.div_ceil(*divisor);
                let mut film = Film::new(side(self.film.width()), side(self.film.height()));
                self.add(studio, camera, &mut film, 0..1, stop);
                speed.measure(film.pixels().len() as u64, 1, start.elapsed());
                self.coarse = Some(film);
                self.progress.coarse = Some(*divisor);
            }
            Pass::Samples(range) => {
                let mut film = std::mem::replace(&mut self.film, Film::new(0, 0));
                self.add(studio, camera, &mut film, range.clone(), stop);
                let count = range.end - range.start;
                speed.measure(film.pixels().len() as u64, count, start.elapsed());
                self.film = film;
                (self.progress.samples, self.progress.last) = (range.end, count);
            }
        }
        self.time += start.elapsed();
    }

    fn add(
        &self,
        studio: &Studio<'_>,
        camera: &CameraDescription,
        film: &mut Film,
        samples: Range<u64>,
        stop: &AtomicBool,
    ) {
        let camera = Camera::new(camera, film.width(), film.height());
        let integrator = &*self.integrator;
        let streams = Streams::independent(studio.seed);
        studio.pool.install(|| {
            render_from(&camera, integrator, studio.scene, film, samples, streams, stop);
        });
    }

    /// The picture so far, with its error against a reference of the same size; `None` before the first pass.
    pub fn picture(&self, reference: Option<&Reference>) -> Option<Picture> {
        let has_samples = self.progress.samples > 0;
        let film = if has_samples { &self.film } else { self.coarse.as_ref()? };
        let image = image(film, Pixel::mean);
        let is_radiance = matches!(self.algorithm, Algorithm::PathTracer(_));
        let reference = reference.filter(|_| has_samples && is_radiance);
        let relative_mse = reference.map(|reference| reference.relative_mse(&image));
        Some(Picture {
            algorithm: self.algorithm,
            image,
            samples: self.progress.samples,
            time: self.time,
            relative_mse,
            anomalies: film.anomalies().clone(),
        })
    }
}

/// A value of each pixel of a film as an image.
pub fn image(film: &Film, value: impl Fn(&Pixel) -> Rgb) -> Image {
    let pixels = film.pixels().iter().map(value).collect();
    Image::from_pixels(film.width() as usize, film.height() as usize, pixels)
}
