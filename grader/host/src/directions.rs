//! Sampling directions of an environment.

use arty::environment::Environment;
use arty::sampler::Sampler;
use arty::scene::Scene;

use crate::protocol::{DirectionJob, SampledDirection, SampledDirections};
use crate::submission::Submission;

/// Samples as many directions as the job asks for. `None` without an environment, or if the submission samples none.
pub(crate) fn sample(submission: Submission, scene: &Scene, job: &DirectionJob) -> Option<SampledDirections> {
    let environment: &Environment = scene.environment()?;
    let directions = submission.directions?(environment);
    let sample = |index: u32| {
        let sampler = &mut Sampler::new(job.seed, (0, 0), u64::from(index));
        let sample = directions.sample(environment, sampler)?;
        let density = directions.pdf(environment, sample.wi);
        Some(SampledDirection { wi: sample.wi, pdf: sample.pdf, density })
    };
    let samples = (0..job.samples).map(sample).collect();
    let densities = job.directions.iter().map(|&wi| directions.pdf(environment, wi)).collect();
    Some(SampledDirections { samples, densities })
}
