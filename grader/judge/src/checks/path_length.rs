//! **path-length**: do paths bounce as often as they are asked to?
//!
//! In a closed room of mirrors a path ends by `max_bounces` or by Russian roulette alone. A limit of the submission's own
//! shows as many paths that all end at the same bounce: were it roulette that survives with probability q, that would
//! have a probability of (1 − q)ⁿ. Images hardly show it: after ten bounces little light is left.

use std::ops::RangeInclusive;

use arty::integrator::Settings;
use arty::math::{Rgb, Vec3};
use arty::scene::{Material, Specular};
use host::protocol::{ProbeJob, ScriptedScene};
use verdict::check::{CheckKind, Evidence, PathLengths, Reason};
use verdict::rubric::CheckSpec;

use super::{Check, GradeContext, JobError, Observation, Outcome};
use crate::scenes;

/// Paths for each number of bounces.
const PATHS: u64 = 1 << 14;

/// So many paths that end at the longest length are no roulette: with q of at least 1/4 that would happen once in 10⁸
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

    fn run(&self, context: &GradeContext<'_>, spec: &CheckSpec) -> Result<Outcome, JobError> {
        let mut process = context.start()?;
        let (mut limit, mut samples) = (None, 0);
        // Powers of two, and what is asked for: a limit below is told by the first length that it cuts off.
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
            // One ray leaves the camera.
            let bounces: Vec<u32> = paths.iter().flatten().map(|path| path.rays.saturating_sub(1)).collect();
            limit = limit.or_else(|| own_limit(&bounces, max_bounces));
        }
        let evidence = PathLengths { max_bounces: spec.max_bounces, limit };
        let reason = if limit.is_some() { Reason::Bias } else { Reason::None };
        Ok(Outcome::new(reason, Evidence::PathLength(evidence), samples))
    }

    fn observations(&self, _: &Evidence) -> Vec<Observation> {
        Vec::new()
    }
}

/// The number of bounces at which a submission ends all paths, if that is less than it may be.
fn own_limit(bounces: &[u32], max_bounces: u32) -> Option<u32> {
    let longest = bounces.iter().copied().max().unwrap_or(0);
    let ended_there = bounces.iter().filter(|&&length| length == longest).count();
    (longest < max_bounces && ended_there >= TOO_MANY).then_some(longest)
}

/// A closed room of mirrors with a light in it. Its color is not white: white may be a special case.
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
    fn many_paths_that_end_alike_are_cut_off_and_a_few_are_roulette() {
        assert_eq!(own_limit(&[16; 5000], 16), None);
        assert_eq!(own_limit(&[10; 5000], 16), Some(10));
        // Each path survives with probability 1/2: of 16,384 one reaches 14 bounces.
        let roulette: Vec<u32> = (0..14).flat_map(|length| vec![length; 8192 >> length]).collect();
        assert_eq!(own_limit(&roulette, 16), None);
        assert_eq!(own_limit(&[], 16), None);
    }
}
