//! **efficiency**: is it really next event estimation, really multiple importance sampling?
//!
//! Means cannot tell: BSDF sampling is right wherever light has an area. Noise can. In scenes where a technique is at
//! least 20 times less noisy than those that it is made of, its variance is compared with what the reference
//! says of each of them, at equal numbers of samples.

use arty::integrator::Technique;
use arty::sampler::batch_seed;
use host::protocol::RenderJob;
use verdict::check::{CheckKind, Evidence, Noise, Reason, VarianceOf, WhyNot};
use verdict::error::Error;
use verdict::rubric::{CheckSpec, rivals};

use super::context::settings_of;
use super::{Check, GradeContext, JobError, Observation, Outcome, Quantity, SceneWithReference};
use crate::reference::SIZE;
use crate::statistics::batches::Batches;
use crate::statistics::bias::Expected;
use crate::statistics::variance::VarianceRatio;

/// How much noisier the other technique has to be for a scene to tell.
const TELLING: f64 = 20.0;

/// How much noisier than the solution a submission has to be, at least, to lack a technique.
const LACKING: f64 = 3.0;

/// The level at which it has to be that.
const LEVEL: f64 = 1e-5;

/// Independent renderings, and samples of each pixel in each.
const BATCHES: u64 = 64;
const SAMPLES: u64 = 8;

/// How much noisier than the solution a correct submission has to be to be told so.
const NOISIER: f64 = 1.5;

pub(super) struct Efficiency;

impl Check for Efficiency {
    fn kind(&self) -> CheckKind {
        CheckKind::Efficiency
    }

    fn techniques(&self) -> &'static [Technique] {
        &[Technique::Nee, Technique::Mis]
    }

    fn telling_bounces(&self, _: u32) -> u32 {
        // Differences in noise are largest in direct light.
        1
    }

    fn applies(&self, scene: &SceneWithReference, spec: &CheckSpec) -> Result<(), WhyNot> {
        let features = scene.scene.features();
        if features.area_lights == 0 {
            return Err(WhyNot::OneTechnique);
        }
        if features.lit_surfaces == 0 {
            return Err(WhyNot::NothingLit);
        }
        tells_apart(scene, spec)
    }

    fn run(&self, context: &GradeContext<'_>, spec: &CheckSpec) -> Result<Outcome, JobError> {
        let scene = context.scene(spec);
        let moments = |technique| moments(scene, spec, technique);
        let own = moments(spec.technique)?;
        let seed = context.seed_of(spec);
        let mut process = context.start()?;
        let loaded = process.load(&scene.description)?;
        let seeds = (0..BATCHES).map(|batch| batch_seed(seed, batch)).collect();
        let job = RenderJob::new(loaded, settings_of(spec), [SIZE.0, SIZE.1], seeds, SAMPLES);
        let mut batches = Batches::default();
        batches.extend(&process.render(&job)?.batches, SAMPLES);
        let samples = batches.samples_per_pixel() * u64::from(SIZE.0 * SIZE.1);

        let ratio_to = |expected: &Expected| VarianceRatio::new(&batches, &own.mean, &expected.deviation);
        let mut noise = Noise { ratios: Vec::new(), as_noisy_as: None, is_noisier: false };
        let Some(ratio) = ratio_to(&own) else {
            return Ok(Outcome::new(Reason::Efficiency, Evidence::Efficiency(noise), samples));
        };
        noise.ratios.push(VarianceOf { technique: spec.technique, ratio: ratio.ratio() });
        let mut nearest = (spec.technique, ratio.log.abs());
        for &technique in rivals(spec.technique) {
            let rival = moments(technique)?;
            let Some(to_rival) = ratio_to(&rival) else { continue };
            noise.ratios.push(VarianceOf { technique, ratio: to_rival.ratio() });
            // A technique that is hardly noisier here does not tell.
            if total(&rival) / total(&own) >= TELLING && to_rival.log.abs() < nearest.1 {
                nearest = (technique, to_rival.log.abs());
            }
        }
        // Noisier than the solution, and just as noisy as what it is made of: anything else is a style of its own.
        let is_lacking =
            ratio.at_least(LEVEL) > LACKING && nearest.0 != spec.technique && nearest.1 < LACKING.ln();
        noise.as_noisy_as = is_lacking.then_some(nearest.0);
        noise.is_noisier = ratio.at_least(LEVEL) > NOISIER;
        let reason = if is_lacking { Reason::Efficiency } else { Reason::None };
        Ok(Outcome::new(reason, Evidence::Efficiency(noise), samples))
    }

    fn observations(&self, evidence: &Evidence) -> Vec<Observation> {
        let Evidence::Efficiency(noise) = evidence else { return Vec::new() };
        let of = |variance: &VarianceOf| {
            Observation::ratio(Quantity::Noise(variance.technique), variance.ratio, 0.0)
        };
        noise.ratios.iter().map(of).collect()
    }
}

/// Whether a technique can be told from at least one other by its noise there.
fn tells_apart(scene: &SceneWithReference, spec: &CheckSpec) -> Result<(), WhyNot> {
    let moments = |technique| moments(scene, spec, technique).map_err(|_| WhyNot::UnknownNoise);
    let own = moments(spec.technique)?;
    let mut max = 0.0f64;
    for &technique in rivals(spec.technique) {
        max = max.max(total(&moments(technique)?) / total(&own));
    }
    if max < TELLING { Err(WhyNot::AlikeNoise { at_most: max, needed: TELLING }) } else { Ok(()) }
}

/// The variance of one sample over the whole image, relative to m² + m̄².
fn total(expected: &Expected) -> f64 {
    let count = 3.0 * expected.mean.len().max(1) as f64;
    let image_mean = expected.mean.iter().flatten().sum::<f64>() / count;
    let pairs = expected.deviation.iter().flatten().zip(expected.mean.iter().flatten());
    pairs.map(|(deviation, mean)| deviation.powi(2) / (mean.powi(2) + image_mean.powi(2))).sum()
}

fn moments(scene: &SceneWithReference, spec: &CheckSpec, technique: Technique) -> Result<Expected, Error> {
    let mut spec = spec.clone();
    spec.technique = technique;
    super::mean_bias::expected(&spec, &scene.reference)
}
