//! **path-length**: do paths have up to `max_bounces` bounces?
//!
//! In a closed room of mirrors, only `max_bounces` and Russian roulette end a path. A smaller limit in the submission
//! shows as n paths that all end at the same bounce: under Russian roulette with survival probability q, that has a
//! probability of (1 − q)ⁿ. Images hardly show it, since little light is left after ten bounces.

use std::ops::RangeInclusive;

use arty::integrator::Settings;
use arty::math::{Rgb, Vec3};
use arty::scene::{Material, Specular};
use host::protocol::{ProbeJob, ScriptedScene};
use verdict::check::{CheckKind, Evidence, PathLengths, Reason};
use verdict::rubric::CheckSpec;

use super::{Check, CheckOutcome, GradeContext, JobError, Observation};
use crate::scenes;

/// Number of paths for each maximum number of bounces.
const PATHS: u64 = 1 << 14;

/// Number of paths of maximum length that rule out Russian roulette: with q of at least 1/4 this happens once in 10⁸
/// submissions.
const TOO_MANY: usize = 64;

pub(super) struct PathLength;

impl Check for PathLength {
    fn kind(&self) -> CheckKind {
        CheckKind::PathLength
    }

    fn bounces(&self) -> RangeInclusive<u32> {
        1..=64
    }

    fn run(&self, context: &GradeContext<'_>, spec: &CheckSpec) -> Result<CheckOutcome, JobError> {
        let mut process = context.start()?;
        let (mut limit, mut samples) = (None, 0);
        // Powers of two and `max_bounces`: the first length that is cut off reveals the limit.
        let doubled = std::iter::successors(Some(1), |bounces| Some(2 * bounces));
        let lengths = doubled.take_while(|&bounces| bounces < spec.max_bounces).chain([spec.max_bounces]);
        for max_bounces in lengths {
            let job = ProbeJob {
                settings: Settings { technique: spec.technique, max_bounces },
                scenes: vec![room_of_mirrors()],
                samples: PATHS,
                seed: context.seed_of(spec),
                stratified: false,
            };
            let paths = process.probe(&job)?;
            samples += PATHS;
            // The camera ray is not a bounce.
            let bounces: Vec<u32> = paths.iter().flatten().map(|path| path.rays.saturating_sub(1)).collect();
            limit = limit.or_else(|| own_limit(&bounces, max_bounces));
        }
        let evidence = PathLengths { max_bounces: spec.max_bounces, limit };
        let reason = if limit.is_some() { Reason::Bias } else { Reason::None };
        Ok(CheckOutcome::new(reason, Evidence::PathLength(evidence), samples))
    }

    fn observations(&self, _: &Evidence) -> Vec<Observation> {
        Vec::new()
    }
}

/// Number of bounces at which a submission ends all paths; `None` if that is `max_bounces`.
fn own_limit(bounces: &[u32], max_bounces: u32) -> Option<u32> {
    let longest = bounces.iter().copied().max().unwrap_or(0);
    let ended_there = bounces.iter().filter(|&&length| length == longest).count();
    (longest < max_bounces && ended_there >= TOO_MANY).then_some(longest)
}

/// A closed room of mirrors with a point light. The mirrors are not white, which might be a special case.
fn room_of_mirrors() -> ScriptedScene {
    let mut scene = scenes::empty();
    let mirror = Specular::Mirror { reflectance: Rgb::new(0.99, 0.98, 0.97) };
    scenes::add(&mut scene, &scenes::cube(), Material { specular: mirror, ..scenes::grey(0.0, 0.0) });
    scene.lights = vec![scenes::point_light(Vec3::new(0.3, 0.8, 0.2), Rgb::WHITE)];
    ScriptedScene {
        scene,
        bsdfs: vec![None],
        lights: Vec::new(),
        origin: Vec3::new(0.1, 0.2, 0.9),
        direction: Vec3::new(0.2, -0.1, -1.0).normalize(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_limit_is_found_and_roulette_is_not_mistaken_for_one() {
        assert_eq!(own_limit(&[16; 5000], 16), None);
        assert_eq!(own_limit(&[10; 5000], 16), Some(10));
        // With a survival probability of 1/2, one of 16,384 paths reaches 14 bounces.
        let roulette: Vec<u32> = (0..14).flat_map(|length| vec![length; 8192 >> length]).collect();
        assert_eq!(own_limit(&roulette, 16), None);
        assert_eq!(own_limit(&[], 16), None);
    }
}
