//! **sampling**: are directions of an environment sampled with the density that the submission reports, and is that the one
//! that the sheet asks for?
//!
//! Maps are made for what goes wrong: poles, seam, odd sizes, one row, one column, one texel, one bright texel among a
//! million, no light at all. Their radiances depend on the seed of the grade, so that no code can fit them. For each map, the
//! submission samples directions, and returns its density for others. The density must integrate to one, over each texel to
//! the texel's probability, and be that of the samples (χ² over texels, and over parts of texels). The sheet asks for
//! probabilities of texels; within a texel, any density will do that the samples have, too.

mod maps;
mod test;
#[cfg(test)]
mod tests;
mod truth;

use std::ops::RangeInclusive;

use arty::integrator::Technique;
use arty::math::Vec3;
use arty::scene::SceneDescription;
use host::protocol::{DirectionJob, SampledDirections};
use verdict::check::{CheckKind, Evidence, Reason, SampledMap, SamplingFlaw, SamplingTest};
use verdict::rubric::CheckSpec;

use super::{Check, CheckOutcome, GradeContext, JobError, Observation, WrongPlace};
use crate::scenes;
use test::Measured;
use truth::Truth;

/// Number of samples for each map.
const SAMPLES: u32 = 1 << 17;

pub(super) struct Sampling;

impl Check for Sampling {
    fn kind(&self) -> CheckKind {
        CheckKind::Sampling
    }

    fn techniques(&self) -> &'static [Technique] {
        &[Technique::Nee, Technique::Mis]
    }

    fn bounces(&self) -> RangeInclusive<u32> {
        1..=1
    }

    fn run(&self, context: &GradeContext<'_>, spec: &CheckSpec) -> Result<CheckOutcome, JobError> {
        let mut process = context.start()?;
        let seed = context.seed_of(spec);
        let mut samples = 0;
        let mut sample = |scene: &SceneDescription, directions: Vec<Vec3>| {
            let scene = process.load(scene)?;
            samples += u64::from(SAMPLES);
            process.directions(&DirectionJob { scene, samples: SAMPLES, seed, directions })
        };
        let evidence = test_all(seed, &mut sample)?;
        let reason = match evidence.flaw {
            None => Reason::None,
            Some(SamplingFlaw::NoDensity | SamplingFlaw::NoDirection) => Reason::Numerics,
            Some(SamplingFlaw::Noise) => Reason::Efficiency,
            Some(_) => Reason::Bias,
        };
        Ok(CheckOutcome::new(reason, Evidence::Sampling(evidence), samples))
    }

    fn observations(&self, evidence: &Evidence) -> Vec<Observation> {
        let Evidence::Sampling(SamplingTest { map, flaw: Some(_), .. }) = evidence else { return Vec::new() };
        vec![Observation::wrong_at(WrongPlace::Map(*map))]
    }
}

/// Tests all maps, up to the first that is wrong. `sample` returns samples, and the densities of directions.
fn test_all<Failure>(
    seed: u64,
    sample: &mut impl FnMut(&SceneDescription, Vec<Vec3>) -> Result<SampledDirections, Failure>,
) -> Result<SamplingTest, Failure> {
    let mut tested = None;
    for (kind, number) in maps::ORDER.into_iter().zip(1..) {
        let result = test_map(kind, number, seed, sample)?;
        let is_wrong = result.flaw.is_some();
        tested = Some(result);
        if is_wrong {
            break;
        }
    }
    Ok(tested.expect("there are maps"))
}

fn test_map<Failure>(
    kind: SampledMap,
    number: u32,
    seed: u64,
    sample: &mut impl FnMut(&SceneDescription, Vec<Vec3>) -> Result<SampledDirections, Failure>,
) -> Result<SamplingTest, Failure> {
    let map = maps::map(kind, seed);
    let truth = Truth::new(&map);
    let points = truth.points();
    let directions = points.iter().map(|point| point.direction).chain(truth.edges()).collect();
    let size = [map.width, map.height];
    let sampled = sample(&SceneDescription { environment: Some(map), ..scenes::empty() }, directions)?;
    let Measured { flaw, integral, variance } = test::test(&truth, &points, &sampled);
    Ok(SamplingTest {
        map: kind,
        size,
        flaw,
        maps: number,
        integral: Some(integral).filter(|integral| integral.is_finite()),
        variance,
        variance_of_uniform: (!truth.is_black()).then_some(truth.variance_of_uniform),
    })
}
