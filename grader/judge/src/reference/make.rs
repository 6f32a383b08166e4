//! Rendering references with the solution.

use std::collections::BTreeMap;

use arty::image::Image;
use arty::integrator::{Settings, Technique};
use arty::math::Rgb;
use arty::sampler::batch_seed;
use arty::scene::SceneDescription;
use host::protocol::{RenderJob, Switches};

use super::file::layer_name;
use super::{Moments, Reference, ReferenceView, SIZE, Wanted};
use crate::statistics::expected::Expected;
use harness::build::SubmissionProgram;
use harness::host_process::HostProcess;
use verdict::error::{Error, Result};
use verdict::rubric::EmissionOnHit;

/// Sample counts of a reference.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Number of batches, from which the variance of the mean is estimated.
    pub batches: u32,
    /// Samples per pixel and batch.
    pub samples: u64,
    /// Samples per pixel for the moments of each technique.
    pub single_samples: u32,
}

impl Default for Effort {
    fn default() -> Self {
        Self { batches: 64, samples: 2048, single_samples: 8192 }
    }
}

/// Renders the reference of one scene with a solution and the reference technique of its assignment. Views with
/// `emission_on_hit: off` are rendered with the technique that they are wanted for: others lack light there.
pub fn make(
    solution: &SubmissionProgram,
    description: &SceneDescription,
    wanted: &Wanted,
    reference_technique: Technique,
    effort: Effort,
    seed: u64,
) -> Result<Reference> {
    let mut renderer = Renderer::start(solution, description, rayon::current_num_threads())?;
    let mut views = BTreeMap::new();
    let mut provenance = BTreeMap::new();
    for (&view, techniques) in wanted {
        let max_bounces = view.max_bounces;
        let emission_on_hit = view.emission_on_hit == EmissionOnHit::On;
        renderer.load(description, Switches { emission_on_hit })?;
        let only = techniques.first().copied().filter(|_| !emission_on_hit);
        let technique = only.unwrap_or(reference_technique);
        let settings = Settings { technique, max_bounces };
        let batches = renderer.render(SIZE, settings, effort.batches, effort.samples, seed)?;
        let (mean, variance) = mean_and_variance(&batches);
        let count = f64::from(effort.batches);
        let variance_of_mean = variance.into_iter().map(|value| value.map(|value| value / count)).collect();
        let mut images = ReferenceView { mean, variance_of_mean, techniques: BTreeMap::new() };
        for &technique in techniques {
            let settings = Settings { technique, max_bounces };
            // In batches of one sample, each mean is a sample.
            let samples = renderer.render(SIZE, settings, effort.single_samples, 1, seed ^ 1)?;
            images.techniques.insert(technique.name(), moments(&samples));
        }
        provenance.insert(format!("{}.technique", layer_name(&view)), technique.to_string());
        views.insert(view, images);
    }
    let samples = u64::from(effort.batches) * effort.samples;
    let of_all = [
        ("samples per pixel", samples.to_string()),
        ("batches", effort.batches.to_string()),
        ("samples per pixel for moments", effort.single_samples.to_string()),
        ("seed", seed.to_string()),
    ];
    provenance.extend(of_all.map(|(key, value)| (key.to_owned(), value)));
    Ok(Reference { scene_hash: description.hash(), views, provenance })
}

/// Expected mean and noise in a scene without a reference, from `samples` samples per pixel of the solution.
pub(super) fn live(
    solution: &SubmissionProgram,
    description: &SceneDescription,
    settings: Settings,
    samples: u32,
    seed: u64,
    threads: usize,
) -> Result<Expected> {
    let mut renderer = Renderer::start(solution, description, threads)?;
    let samples = renderer.render(SIZE, settings, samples, 1, seed)?;
    let (mean, variance) = mean_and_variance(&samples);
    let count = samples.len() as f64;
    let variance_of_mean = variance.into_iter().map(|value| value.map(|value| value / count)).collect();
    let techniques = BTreeMap::from([(settings.technique.name(), moments(&samples))]);
    let images = ReferenceView { mean, variance_of_mean, techniques };
    images
        .expected(settings.technique)
        .ok_or_else(|| Error::Harness("the solution's own rendering has no moments".to_owned()))
}

/// Maximum number of samples per pixel and batch of a display picture.
const PICTURE_BATCH: u64 = 16;

/// Renders a larger picture of a scene for display.
pub fn picture(
    program: &SubmissionProgram,
    description: &SceneDescription,
    settings: Settings,
    (width, height): (u32, u32),
    samples: u64,
    seed: u64,
) -> Result<Image> {
    // In batches, so that each job is short.
    let per_batch = (1..=PICTURE_BATCH).rev().find(|&size| samples.is_multiple_of(size)).unwrap_or(1);
    let batches = u32::try_from(samples / per_batch).unwrap_or(u32::MAX);
    let mut renderer = Renderer::start(program, description, rayon::current_num_threads())?;
    let (mean, _) =
        mean_and_variance(&renderer.render((width, height), settings, batches, per_batch, seed)?);
    let pixels = mean.iter().map(|pixel| Rgb::from(pixel.map(|channel| channel as f32))).collect();
    Ok(Image::from_pixels(width as usize, height as usize, pixels))
}

/// A trusted program with one loaded scene. Its faults are errors of the harness.
struct Renderer {
    process: HostProcess,
    scene: u32,
}

impl Renderer {
    fn start(program: &SubmissionProgram, description: &SceneDescription, threads: usize) -> Result<Self> {
        let mut process = HostProcess::start(program, threads)?;
        let scene = process.load(description).map_err(|error| error.of_trusted("the solution"))?;
        Ok(Self { process, scene })
    }

    /// Loads the scene again, with other switches.
    fn load(&mut self, description: &SceneDescription, switches: Switches) -> Result<()> {
        let loaded = self.process.load_with(description, switches);
        self.scene = loaded.map_err(|error| error.of_trusted("the solution"))?;
        Ok(())
    }

    /// Renders batches, in jobs that stay well within the time limit.
    fn render(
        &mut self,
        (width, height): (u32, u32),
        settings: Settings,
        batches: u32,
        samples: u64,
        seed: u64,
    ) -> Result<Vec<Vec<[f32; 3]>>> {
        let seeds: Vec<u64> = (0..u64::from(batches)).map(|batch| batch_seed(seed, batch)).collect();
        let pixels = u64::from(width) * u64::from(height);
        let per_job = (1_000_000 / (pixels * samples)).max(1) as usize;
        let mut means = Vec::with_capacity(batches as usize);
        for seeds in seeds.chunks(per_job) {
            let job = RenderJob::new(self.scene, settings, [width, height], seeds.to_vec(), samples);
            let rendered = self.process.render(&job).map_err(|error| error.of_trusted("the solution"))?;
            if rendered.non_finite + rendered.negative > 0 {
                let what = format!("{:?}", rendered.first_anomalies.first());
                return Err(Error::Harness(format!(
                    "the solution returned samples that are not radiance: {what}"
                )));
            }
            means.extend(rendered.batches);
        }
        Ok(means)
    }
}

/// Mean over batches and variance between them, by pixel and channel.
fn mean_and_variance(batches: &[Vec<[f32; 3]>]) -> (Vec<[f64; 3]>, Vec<[f64; 3]>) {
    let count = batches.len() as f64;
    let per_value = |f: &dyn Fn(usize, usize) -> f64| -> Vec<[f64; 3]> {
        (0..batches[0].len()).map(|pixel| std::array::from_fn(|channel| f(pixel, channel))).collect()
    };
    let moment = |pixel: usize, channel: usize, center: f64, power: i32| -> f64 {
        batches.iter().map(|batch| (f64::from(batch[pixel][channel]) - center).powi(power)).sum()
    };
    let mean = per_value(&|pixel, channel| moment(pixel, channel, 0.0, 1) / count);
    let variance =
        per_value(&|pixel, channel| moment(pixel, channel, mean[pixel][channel], 2) / (count - 1.0).max(1.0));
    (mean, variance)
}

fn moments(samples: &[Vec<[f32; 3]>]) -> Moments {
    let (mean, variance) = mean_and_variance(samples);
    let count = samples.len() as f64;
    let mut moments = Moments { deviation: vec![[0.0; 3]; mean.len()], skewness: vec![[0.0; 3]; mean.len()] };
    for pixel in 0..mean.len() {
        for channel in 0..3 {
            let (mean, sigma) = (mean[pixel][channel], variance[pixel][channel].sqrt());
            if mean == 0.0 || sigma == 0.0 {
                continue;
            }
            let cubes: f64 = samples
                .iter()
                .map(|sample| ((f64::from(sample[pixel][channel]) - mean) / sigma).powi(3))
                .sum();
            moments.deviation[pixel][channel] = sigma / mean;
            moments.skewness[pixel][channel] = cubes / count;
        }
    }
    moments
}
