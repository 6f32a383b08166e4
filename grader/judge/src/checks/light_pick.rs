//! **light-pick**: does the selection probability that the estimator divides by match the frequency of selection?
//!
//! A red, a green and a blue point light illuminate a diffuse floor, so that each channel shows one light. Its mean is
//! ρ/π · I cos θ / d² for any selection strategy whose probability matches the one in the estimator. An off-by-one
//! such as `random * (n − 0.01)` is an error of less than a percent, which would take millions of paths to detect.
//! Therefore the random numbers of the submission are stratified: the share of each light is exact, and a few thousand
//! paths suffice.
//!
//! With the technique `bsdf`, no light is selected. A path never hits a point light, so these paths must be black: any
//! light in them comes from light samples.

use std::f64::consts::PI;
use std::ops::RangeInclusive;

use arty::integrator::Technique;
use arty::math::{Rgb, Vec3, direction_and_distance};
use arty::sampler::batch_seed;
use glam::DVec3;
use host::protocol::{ProbeJob, ScriptedScene};
use statrs::distribution::{ContinuousCDF, StudentsT};
use verdict::check::{CheckKind, Evidence, LightShares, Reason, WhyNot};
use verdict::rubric::CheckSpec;

use super::context::settings_of;
use super::{Check, CheckOutcome, GradeContext, JobError, Observation, Quantity, SceneWithReference};
use crate::scenes;

/// Number of paths per stratified set, and number of sets.
const PATHS: u64 = 4096;
const SETS: u64 = 8;

/// Relative error explained by rounding and the width of a stratum.
const TOLERATED: f64 = 1e-3;

/// Significance level of an error beyond [`TOLERATED`].
const LEVEL: f64 = 1e-6;

const ALBEDO: f32 = 0.6;
const POWER: f32 = 50.0;

pub(super) struct LightPick;

impl Check for LightPick {
    fn kind(&self) -> CheckKind {
        CheckKind::LightPick
    }

    fn bounces(&self) -> RangeInclusive<u32> {
        1..=1
    }

    fn applies(&self, scene: &SceneWithReference, _: &CheckSpec) -> Result<(), WhyNot> {
        let features = scene.scene.features();
        if features.lit_surfaces == 0 {
            Err(WhyNot::NothingLit)
        } else if features.area_lights + features.point_lights < 2 {
            Err(WhyNot::OneLight)
        } else {
            Ok(())
        }
    }

    fn run(&self, context: &GradeContext<'_>, spec: &CheckSpec) -> Result<CheckOutcome, JobError> {
        let mut process = context.start()?;
        let settings = settings_of(spec);
        let scene = three_lights();
        let mut means = Vec::new();
        for set in 0..SETS {
            let seed = batch_seed(context.seed_of(spec), set);
            let scenes = vec![scene.clone()];
            let paths =
                process.probe(&ProbeJob { settings, scenes, samples: PATHS, seed, stratified: true })?;
            let mut mean = [0.0; 3];
            for path in paths.iter().flatten() {
                (0..3).for_each(|channel| mean[channel] += f64::from(path.radiance[channel]) / PATHS as f64);
            }
            means.push(mean);
        }
        let shares: [Share; 3] = std::array::from_fn(|channel| match spec.technique {
            Technique::Bsdf => Share::of_none(&means, channel),
            Technique::Nee | Technique::Mis => Share::of(&means, channel),
        });
        let wrong = shares.iter().position(|share| !share.ratio.is_finite() || share.p_value < LEVEL);
        let evidence = LightShares {
            excess: shares.each_ref().map(|share| Some(share.ratio).filter(|ratio| ratio.is_finite())),
            wrong: wrong.map(|light| light as u32),
        };
        let reason = if wrong.is_some() { Reason::Bias } else { Reason::None };
        Ok(CheckOutcome::new(reason, Evidence::LightPick(evidence), SETS * PATHS))
    }

    fn observations(&self, evidence: &Evidence) -> Vec<Observation> {
        let Evidence::LightPick(shares) = evidence else { return Vec::new() };
        let of = |(light, excess): (u32, Option<f64>)| {
            Some(Observation::ratio(Quantity::LightShare(light), 1.0 + excess?, 0.0))
        };
        (0..).zip(shares.excess).filter_map(of).collect()
    }
}

/// Contribution of one light.
struct Share {
    /// Relative error of the contribution, or the contribution of a light that should have none.
    ratio: f64,
    /// p-value under correct selection. If the submission uses its random numbers in a way that stratification does not
    /// cover, the contribution varies from set to set, and larger errors are allowed.
    p_value: f64,
}

impl Share {
    /// The contribution of a light that no path can find, relative to that of a light sample. Any is an error.
    fn of_none(means: &[[f64; 3]], channel: usize) -> Self {
        let mean = means.iter().map(|mean| mean[channel]).sum::<f64>() / means.len() as f64;
        Self { ratio: mean / expected(channel), p_value: if mean == 0.0 { 1.0 } else { 0.0 } }
    }

    fn of(means: &[[f64; 3]], channel: usize) -> Self {
        let expected = expected(channel);
        let ratios: Vec<f64> = means.iter().map(|mean| mean[channel] / expected - 1.0).collect();
        let count = ratios.len() as f64;
        let ratio = ratios.iter().sum::<f64>() / count;
        let spread = ratios.iter().map(|other| (other - ratio).powi(2)).sum::<f64>() / (count - 1.0);
        let error = (spread / count).sqrt();
        let excess = (ratio.abs() - TOLERATED).max(0.0);
        let p_value = match (excess > 0.0, error > 0.0) {
            (false, _) => 1.0,
            (true, false) => 0.0,
            (true, true) => StudentsT::new(0.0, 1.0, count - 1.0)
                .map_or(1.0, |distribution| 2.0 * distribution.sf(excess / error)),
        };
        Self { ratio, p_value }
    }
}

/// The point on the floor that the paths hit.
const SEEN: Vec3 = Vec3::new(0.1, 0.0, -0.2);

fn light(index: usize) -> Vec3 {
    let angle = std::f32::consts::TAU * index as f32 / 3.0;
    SEEN + Vec3::new(0.8 * angle.cos(), 1.5, 0.8 * angle.sin())
}

fn expected(channel: usize) -> f64 {
    let to_light = (light(channel) - SEEN).as_dvec3();
    let cos = to_light.normalize().y;
    f64::from(ALBEDO) / PI * f64::from(POWER) / (4.0 * PI) * cos / to_light.length_squared()
}

/// A floor under a red, a green and a blue point light of equal power.
pub(crate) fn three_lights() -> ScriptedScene {
    let eye = Vec3::new(0.5, 2.0, 0.7);
    let mut scene = scenes::empty();
    scene.camera = scenes::camera(eye.as_dvec3(), SEEN.as_dvec3(), 40.0);
    let corner = |x: f64, z: f64| DVec3::new(x, 0.0, z);
    let floor = [corner(-9.0, 9.0), corner(9.0, 9.0), corner(0.0, -9.0)];
    scenes::add(&mut scene, &[floor], scenes::grey(ALBEDO, 0.0));
    scene.lights = (0..3)
        .map(|index| {
            let mut power = [0.0; 3];
            power[index] = POWER;
            scenes::point_light(light(index), Rgb::from(power))
        })
        .collect();
    ScriptedScene {
        scene,
        bsdfs: vec![None],
        lights: Vec::new(),
        origin: eye,
        direction: direction_and_distance(eye, SEEN).0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_error_is_significant_if_exact_and_not_if_noisy() {
        let share = |ratios: &[f64]| {
            let means: Vec<[f64; 3]> = ratios.iter().map(|ratio| [expected(0) * ratio; 3]).collect();
            Share::of(&means, 0)
        };
        assert_eq!(share(&[1.0005; 8]).p_value, 1.0);
        assert!(share(&[0.9966, 0.9967, 0.9966, 0.9967, 0.9966, 0.9967, 0.9966, 0.9967]).p_value < LEVEL);
        assert!(share(&[0.97, 1.02, 1.01, 0.99, 1.03, 0.98, 0.95, 1.01]).p_value > 0.01);
    }

    #[test]
    fn without_light_samples_any_light_is_an_error() {
        let share = |mean: f64| Share::of_none(&[[mean; 3], [0.0; 3]], 0);
        assert_eq!((share(0.0).ratio, share(0.0).p_value), (0.0, 1.0));
        assert!(share(1e-9).p_value < LEVEL && share(f64::NAN).ratio.is_nan());
        assert!((share(2.0 * expected(0)).ratio - 1.0).abs() < 1e-12);
    }
}
