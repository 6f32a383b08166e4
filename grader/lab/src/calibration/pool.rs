//! Recorded samples of single paths, to draw from.

use std::time::Instant;

use arty::integrator::Settings;
use arty::sampler::{Sampler, batch_seed};
use arty::scene::SceneDescription;
use host::protocol::{RenderJob, Switches};

use harness::build::SubmissionProgram;
use harness::host_process::HostProcess;
use harness::job::JobError;
use judge::reference::SIZE;
use judge::statistics::sequential::SampleRequest;

/// Images of one sample each.
pub struct Pool {
    images: Vec<Vec<[f32; 3]>>,
    seconds_per_path: f64,
}

/// Images per job.
const PER_JOB: u64 = 1024;

impl Pool {
    /// Renders `count` images of one sample per pixel.
    ///
    /// # Errors
    /// If the program does not answer, or something else is wrong.
    pub fn record(
        program: &SubmissionProgram,
        scene: &SceneDescription,
        settings: Settings,
        switches: Switches,
        count: u64,
        threads: usize,
        seed: u64,
    ) -> Result<Self, JobError> {
        let mut process = HostProcess::start(program, threads)?;
        let scene = process.load_with(scene, switches)?;
        let mut images = Vec::new();
        let start = Instant::now();
        for first in (0..count).step_by(PER_JOB as usize) {
            let seeds = (first..count.min(first + PER_JOB)).map(|batch| batch_seed(seed, batch)).collect();
            let job = RenderJob::new(scene, settings, SIZE.into(), seeds, 1);
            images.extend(process.render(&job)?.batches);
        }
        let paths = images.len() as f64 * f64::from(SIZE.0 * SIZE.1);
        let seconds_per_path = start.elapsed().as_secs_f64() * threads as f64 / paths.max(1.0);
        Ok(Self { images, seconds_per_path })
    }

    /// A pool of given images.
    #[cfg(test)]
    pub(super) fn of(images: Vec<Vec<[f32; 3]>>) -> Self {
        Self { images, seconds_per_path: 0.0 }
    }

    /// Processor time of one path in seconds, measured while recording.
    pub fn seconds_per_path(&self) -> f64 {
        self.seconds_per_path
    }

    /// Mean of each pixel: the true mean of everything that is drawn from the pool.
    pub fn mean(&self) -> Vec<[f64; 3]> {
        let mut sums = vec![[0.0; 3]; self.images.first().map_or(0, Vec::len)];
        for image in &self.images {
            for (sum, value) in sums.iter_mut().flatten().zip(image.iter().flatten()) {
                *sum += f64::from(*value);
            }
        }
        let count = self.images.len().max(1) as f64;
        sums.into_iter().map(|sum| sum.map(|sum| sum / count)).collect()
    }

    /// The batches that are asked for, averaged over images drawn at random and multiplied by `1 + bias`.
    pub fn draw(&self, request: &SampleRequest, bias: f64) -> Vec<Vec<[f32; 3]>> {
        let scale = ((1.0 + bias) / request.samples as f64) as f32;
        let batch = |&seed: &u64| {
            // Continues the random numbers of the batch's earlier samples.
            let mut random = Sampler::new(seed, (0, 0), request.first_sample);
            let mut sum = vec![[0.0f32; 3]; self.images.first().map_or(0, Vec::len)];
            for _ in 0..request.samples {
                let pick = (random.next_1d() * self.images.len() as f32) as usize;
                let Some(image) = self.images.get(pick) else { continue };
                for (sum, value) in sum.iter_mut().flatten().zip(image.iter().flatten()) {
                    *sum += value;
                }
            }
            sum.iter_mut().flatten().for_each(|value| *value *= scale);
            sum
        };
        request.seeds.iter().map(batch).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_drawn_has_the_mean_of_the_pool() {
        let images = (0..100).map(|i| vec![[i as f32, 2.0, 0.0]]).collect();
        let pool = Pool::of(images);
        assert_eq!(pool.mean(), [[49.5, 2.0, 0.0]]);
        let request = SampleRequest { seeds: vec![1, 2], first_sample: 0, samples: 10_000 };
        let drawn = pool.draw(&request, 0.01);
        assert_ne!(drawn[0], drawn[1]);
        for batch in drawn {
            // Deviation of the mean: 0.29. Beyond 5 of them once in a million.
            assert!((f64::from(batch[0][0]) / 1.01 - 49.5).abs() < 1.5, "{batch:?}");
            assert!((f64::from(batch[0][1]) - 2.02).abs() < 1e-3);
        }
    }
}
