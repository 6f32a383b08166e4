//! **efficiency**: does the submission use next event estimation, and multiple importance sampling?
//!
//! Means do not show it, since BSDF sampling is unbiased wherever lights have an area; variance does. In scenes where
//! a technique has at most 1/20 of the variance of the techniques it is made of, the submission's variance is compared
//! with that of each of them in the reference, at equal sample counts. A submission that averages several paths per
//! sample is measured at an equal number of rays: whole paths of BSDF sampling are not a light sample.
//!
//! With `emission_on_hit: off`, hits contribute nothing to next event estimation, and its noise is that of light samples
//! alone, whatever a submission does with emission.

use arty::integrator::Technique;
use arty::sampler::batch_seed;
use host::protocol::RenderJob;
use verdict::check::{CheckKind, Evidence, Noise, Reason, VarianceOf, WhyNot};
use verdict::error::Error;
use verdict::rubric::{CheckSpec, EmissionOnHit, rivals};

use super::context::{settings_of, switches_of};
use super::{Check, CheckOutcome, GradeContext, JobError, Observation, Quantity, SceneWithReference};
use crate::reference::SIZE;
use crate::statistics::batches::Batches;
use crate::statistics::expected::Expected;
use crate::statistics::variance::VarianceRatio;

/// Minimum variance of the other technique, relative to the tested one, for a scene to distinguish them.
const MIN_RIVAL_RATIO: f64 = 20.0;

/// Minimum variance, relative to the solution, of a submission that lacks a technique.
const MISSING_TECHNIQUE_RATIO: f64 = 3.0;

/// Significance level of that comparison.
const LEVEL: f64 = 1e-5;

/// Number of batches, and samples per pixel of each batch.
const BATCHES: u64 = 64;
const SAMPLES: u64 = 8;

/// Minimum variance, relative to the solution, that is reported for a correct submission.
const NOISIER_RATIO: f64 = 1.5;

/// Rays per bounce that a sample may take before its variance is compared at an equal number of rays: a shadow ray, the
/// next ray of the path and one ray for multiple importance sampling.
const RAYS_PER_BOUNCE: f64 = 3.0;

pub(super) struct Efficiency;

impl Check for Efficiency {
    fn kind(&self) -> CheckKind {
        CheckKind::Efficiency
    }

    fn techniques(&self) -> &'static [Technique] {
        &[Technique::Nee, Technique::Mis]
    }

    fn isolates_next_event_estimation(&self) -> bool {
        true
    }

    fn recommended_bounces(&self, _: u32) -> u32 {
        // The variances differ most in direct light.
        1
    }

    fn applies(&self, scene: &SceneWithReference, spec: &CheckSpec) -> Result<(), WhyNot> {
        let features = scene.scene.features();
        if features.area_lights == 0 && !features.environment {
            return Err(WhyNot::OneTechnique);
        }
        if features.lit_surfaces == 0 {
            return Err(WhyNot::NothingLit);
        }
        distinguishes(scene, spec)
    }

    fn run(&self, context: &GradeContext<'_>, spec: &CheckSpec) -> Result<CheckOutcome, JobError> {
        let scene = context.scene(spec);
        let moments = |technique| moments(scene, spec, technique);
        let own = moments(spec.technique)?;
        let seed = context.seed_of(spec);
        let mut process = context.start()?;
        let loaded = process.load_with(&scene.description, switches_of(spec))?;
        let seeds = (0..BATCHES).map(|batch| batch_seed(seed, batch)).collect();
        let job = RenderJob::new(loaded, settings_of(spec), [SIZE.0, SIZE.1], seeds, SAMPLES);
        let mut batches = Batches::default();
        let rendered = process.render(&job)?;
        batches.extend(&rendered.batches, SAMPLES);
        let samples = batches.samples_per_pixel() * u64::from(SIZE.0 * SIZE.1);

        let excess = excess_of_rays(rendered.rays as f64 / samples as f64, spec.max_bounces);
        let ratio_to = |expected: &Expected| {
            let ratio = VarianceRatio::new(&batches, &own.mean, &expected.deviation)?;
            Some(VarianceRatio { log: ratio.log + excess.ln(), ..ratio })
        };
        let mut noise = Noise { ratios: Vec::new(), as_noisy_as: None, is_noisier: false };
        let Some(ratio) = ratio_to(&own) else {
            // Black: area lights have not been begun, and the tests of means say so. Nothing else was sampled instead.
            if spec.emission_on_hit == EmissionOnHit::Off {
                return Ok(CheckOutcome::new(Reason::None, Evidence::Efficiency(noise), samples));
            }
            return Ok(CheckOutcome::new(Reason::Efficiency, Evidence::Efficiency(noise), samples));
        };
        noise.ratios.push(VarianceOf { technique: spec.technique, ratio: ratio.ratio() });
        let mut nearest = (spec.technique, ratio.log.abs());
        for &technique in rivals(spec.technique) {
            let rival = moments(technique)?;
            let Some(to_rival) = ratio_to(&rival) else { continue };
            noise.ratios.push(VarianceOf { technique, ratio: to_rival.ratio() });
            // Another technique with a similar variance cannot be distinguished here.
            if relative_variance(&rival) / relative_variance(&own) >= MIN_RIVAL_RATIO
                && to_rival.log.abs() < nearest.1
            {
                nearest = (technique, to_rival.log.abs());
            }
        }
        // Noisier than the solution and as noisy as another technique. Any other variance is a matter of style.
        let is_missing = ratio.at_least(LEVEL) > MISSING_TECHNIQUE_RATIO
            && nearest.0 != spec.technique
            && nearest.1 < MISSING_TECHNIQUE_RATIO.ln();
        noise.as_noisy_as = is_missing.then_some(nearest.0);
        // Without emission on hit there is no other light than that of light samples: so much noise cannot be theirs.
        if spec.emission_on_hit == EmissionOnHit::Off && ratio.at_least(LEVEL) > MIN_RIVAL_RATIO {
            noise.as_noisy_as = Some(Technique::Bsdf);
        }
        noise.is_noisier = ratio.at_least(LEVEL) > NOISIER_RATIO;
        let reason = if noise.as_noisy_as.is_some() { Reason::Efficiency } else { Reason::None };
        Ok(CheckOutcome::new(reason, Evidence::Efficiency(noise), samples))
    }

    fn observations(&self, evidence: &Evidence) -> Vec<Observation> {
        let Evidence::Efficiency(noise) = evidence else { return Vec::new() };
        let of = |variance: &VarianceOf| {
            Observation::ratio(Quantity::Noise(variance.technique), variance.ratio, 0.0)
        };
        noise.ratios.iter().map(of).collect()
    }
}

/// Factor by which a mean of `rays` rays per sample exceeds what one path needs; 1 if it does not.
fn excess_of_rays(rays: f64, max_bounces: u32) -> f64 {
    (rays / (1.0 + RAYS_PER_BOUNCE * f64::from(max_bounces))).max(1.0)
}

/// Checks that the scene distinguishes the technique from at least one other by its variance.
fn distinguishes(scene: &SceneWithReference, spec: &CheckSpec) -> Result<(), WhyNot> {
    let moments = |technique| moments(scene, spec, technique).map_err(|_| WhyNot::UnknownNoise);
    let own = moments(spec.technique)?;
    let mut max = 0.0f64;
    for &technique in rivals(spec.technique) {
        max = max.max(relative_variance(&moments(technique)?) / relative_variance(&own));
    }
    if max < MIN_RIVAL_RATIO {
        Err(WhyNot::AlikeNoise { at_most: max, needed: MIN_RIVAL_RATIO })
    } else {
        Ok(())
    }
}

/// Variance of one sample, summed over the image relative to m² + m̄² (mean of the pixel and mean of the image).
fn relative_variance(expected: &Expected) -> f64 {
    let count = 3.0 * expected.mean.len().max(1) as f64;
    let image_mean = expected.mean.iter().flatten().sum::<f64>() / count;
    let pairs = expected.deviation.iter().flatten().zip(expected.mean.iter().flatten());
    pairs.map(|(deviation, mean)| deviation.powi(2) / (mean.powi(2) + image_mean.powi(2))).sum()
}

fn moments(scene: &SceneWithReference, spec: &CheckSpec, technique: Technique) -> Result<Expected, Error> {
    let mut spec = spec.clone();
    // BSDF sampling finds nothing in lights that are black when hit: it is compared as it is otherwise.
    if technique == Technique::Bsdf {
        spec.emission_on_hit = EmissionOnHit::On;
    }
    spec.technique = technique;
    super::mean_bias::expected(&spec, &scene.reference)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_several_paths_per_sample_exceed_the_rays_of_one() {
        // A camera ray, a shadow ray, the next ray and one for multiple importance sampling.
        assert_eq!([2.0, 3.0, 4.0].map(|rays| excess_of_rays(rays, 1)), [1.0; 3]);
        // Twelve paths of BSDF sampling.
        assert_eq!(excess_of_rays(24.0, 1), 6.0);
    }
}
