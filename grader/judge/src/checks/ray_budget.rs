//! **ray-budget**: how many rays does a path trace?
//!
//! The sheet asks for a single shadow ray at each hit point. Students may trace it with `occluded` or with
//! `intersect`, and may trace a separate ray for multiple importance sampling: at most three rays per bounce and one
//! camera ray. Only paths that exceed this or do not end cost points. Shadow rays that cannot contribute are reported
//! as remarks.
//!
//! With BSDF sampling alone, the ray that goes on is the only one at each hit point, and Russian roulette ends most long
//! paths early: in a room with dark walls, where at least [`LONG`] bounces are asked for, the mean path has to be at most
//! half as long. Any survival probability that follows the throughput, or that is at most 0.95 from the fifth bounce on,
//! is far below that.

use std::ops::RangeInclusive;

use arty::integrator::{Settings, Technique};
use arty::math::{Rgb, Vec3};
use arty::scene::{Material, SceneDescription, Specular};
use host::protocol::{ProbeJob, ProbedPath, ScriptedScene};
use verdict::check::{CheckKind, Evidence, Fault, RayCounts, Reason, TooManyRays, WhyNot};
use verdict::rubric::CheckSpec;

use super::{Check, CheckOutcome, GradeContext, JobError, Observation, SceneWithReference};
use crate::scenes;

/// Number of lights in the room: more than a path may sample.
const LIGHTS: u32 = 8;

/// Number of paths per room.
const PATHS: u64 = 256;

/// Maximum number of bounces from which on Russian roulette is expected of BSDF sampling.
const LONG: u32 = 32;

pub(super) struct RayBudget;

impl Check for RayBudget {
    fn kind(&self) -> CheckKind {
        CheckKind::RayBudget
    }

    fn techniques(&self) -> &'static [Technique] {
        &Technique::ALL
    }

    fn bounces(&self) -> RangeInclusive<u32> {
        1..=64
    }

    fn recommended_bounces(&self, _: u32) -> u32 {
        3
    }

    fn applies(&self, scene: &SceneWithReference, _: &CheckSpec) -> Result<(), WhyNot> {
        if scene.scene.features().lit_surfaces == 0 { Err(WhyNot::NothingLit) } else { Ok(()) }
    }

    fn run(&self, context: &GradeContext<'_>, spec: &CheckSpec) -> Result<CheckOutcome, JobError> {
        let mut process = context.start()?;
        let seed = context.seed_of(spec);
        let mut samples = 0;
        let mut probe = |scene: SceneDescription, max_bounces: u32| -> Result<Vec<ProbedPath>, JobError> {
            let bsdfs = vec![None; scene.materials.len()];
            let scripted = ScriptedScene {
                scene,
                bsdfs,
                lights: Vec::new(),
                origin: Vec3::new(0.1, 0.2, 0.9),
                direction: Vec3::new(0.2, -0.1, -1.0).normalize(),
            };
            let settings = Settings { technique: spec.technique, max_bounces };
            let job = ProbeJob { settings, scenes: vec![scripted], samples: PATHS, seed, stratified: false };
            samples += PATHS;
            Ok(process.probe(&job)?.into_iter().flatten().collect())
        };
        if spec.technique == Technique::Bsdf {
            let paths = probe(dark_room(), spec.max_bounces)?;
            let excess = too_long(&paths, spec.max_bounces);
            let counts = RayCounts {
                excess,
                lights: LIGHTS,
                shadow_rays_at_mirrors: false,
                shadow_rays_without_lights: false,
                panic_without_lights: None,
            };
            let reason = if excess.is_some() { Reason::RayBudget } else { Reason::None };
            return Ok(CheckOutcome::new(reason, Evidence::RayBudget(counts), samples));
        }
        let mut excess = None;
        for bounces in 1..=spec.max_bounces {
            let paths = probe(room(Specular::None, LIGHTS), bounces)?;
            excess = excess.or_else(|| too_many(&paths, bounces));
        }
        let mirror = Specular::Mirror { reflectance: Rgb::gray(0.9) };
        let at_mirrors = probe(room(mirror, LIGHTS), spec.max_bounces)?;
        // A panic there says nothing about the rays in the other rooms.
        let (without_lights, panic_without_lights) = match probe(room(Specular::None, 0), spec.max_bounces) {
            Ok(paths) => (paths, None),
            Err(JobError::Submission(Fault::Panic(message))) => (Vec::new(), Some(message)),
            Err(other) => return Err(other),
        };
        let some = |paths: &[ProbedPath]| paths.iter().any(|path| path.shadow_rays > 0);
        let counts = RayCounts {
            excess,
            lights: LIGHTS,
            shadow_rays_at_mirrors: some(&at_mirrors),
            shadow_rays_without_lights: some(&without_lights),
            panic_without_lights,
        };
        let reason = match (excess, &counts.panic_without_lights) {
            (Some(_), _) => Reason::RayBudget,
            (None, Some(_)) => Reason::Crash,
            (None, None) => Reason::None,
        };
        Ok(CheckOutcome::new(reason, Evidence::RayBudget(counts), samples))
    }

    fn observations(&self, _: &Evidence) -> Vec<Observation> {
        Vec::new()
    }
}

/// The rays of paths that exceed the budget; `None` if no path does.
fn too_many(paths: &[ProbedPath], bounces: u32) -> Option<TooManyRays> {
    let max = |count: fn(&ProbedPath) -> u32| paths.iter().map(count).max().unwrap_or(0);
    let (shadow_rays, rays) = (max(|path| path.shadow_rays), max(|path| path.rays + path.shadow_rays));
    let allowed = 1 + 3 * bounces;
    (shadow_rays > bounces || rays > allowed).then_some(TooManyRays { bounces, shadow_rays, rays, allowed })
}

/// The mean number of rays of paths of BSDF sampling that exceed the budget; `None` if they do not.
fn too_long(paths: &[ProbedPath], bounces: u32) -> Option<TooManyRays> {
    let mean = |count: fn(&ProbedPath) -> u32| {
        let sum: u64 = paths.iter().map(|path| u64::from(count(path))).sum();
        sum.div_ceil(paths.len().max(1) as u64) as u32
    };
    let (shadow_rays, rays) = (mean(|path| path.shadow_rays), mean(|path| path.rays + path.shadow_rays));
    let allowed = if bounces < LONG { 1 + bounces } else { bounces / 2 };
    (rays > allowed).then_some(TooManyRays { bounces, shadow_rays, rays, allowed })
}

/// A closed room with walls that reflect half of the light.
fn dark_room() -> SceneDescription {
    let mut scene = room(Specular::None, LIGHTS);
    scene.materials.iter_mut().for_each(|material| material.diffuse = Rgb::gray(0.5));
    scene
}

/// A closed room with walls of one material and point lights under its ceiling.
fn room(specular: Specular, lights: u32) -> SceneDescription {
    let mut scene = scenes::empty();
    let diffuse = if specular == Specular::None { 0.9 } else { 0.0 };
    scenes::add(&mut scene, &scenes::cube(), Material { specular, ..scenes::grey(diffuse, 0.0) });
    let light = |index: u32| {
        let angle = std::f32::consts::TAU * index as f32 / LIGHTS as f32;
        scenes::point_light(Vec3::new(0.5 * angle.cos(), 0.8, 0.5 * angle.sin()), Rgb::WHITE)
    };
    scene.lights = (0..lights).map(light).collect();
    scene
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paths(rays: u32, shadow_rays: u32) -> Vec<ProbedPath> {
        vec![ProbedPath { radiance: [0.0; 3], rays, shadow_rays, light_samples: 1 }; 2]
    }

    #[test]
    fn one_shadow_ray_per_bounce_is_allowed_however_it_is_traced() {
        for (rays, shadow_rays, bounces) in [(2, 1, 1), (3, 0, 1), (4, 0, 1), (3, 1, 1), (4, 3, 3), (1, 0, 1)]
        {
            assert_eq!(too_many(&paths(rays, shadow_rays), bounces), None, "{rays} + {shadow_rays}");
        }
        for (rays, shadow_rays, bounces) in [(2, 8, 1), (10, 0, 1), (5, 0, 1), (4, 24, 3), (40, 1, 1)] {
            assert!(too_many(&paths(rays, shadow_rays), bounces).is_some(), "{rays} + {shadow_rays}");
        }
    }

    #[test]
    fn long_paths_of_bsdf_sampling_have_to_end_early() {
        for (rays, bounces) in [(9, 64), (32, 64), (9, 8), (16, 32)] {
            assert_eq!(too_long(&paths(rays, 0), bounces), None, "{rays} of {bounces}");
        }
        for (rays, bounces) in [(65, 64), (33, 64), (10, 8), (33, 32)] {
            assert!(too_long(&paths(rays, 0), bounces).is_some(), "{rays} of {bounces}");
        }
    }

    #[test]
    fn the_room_is_closed() {
        assert!(arty::scene::Scene::new(&room(Specular::None, 2)).features().closed);
    }
}
