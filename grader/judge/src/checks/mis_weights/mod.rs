//! **mis-weights**: do the MIS weights sum to one, and do they depend on the right densities?
//!
//! Let K = f · L · cos θ be the contribution of one light point along one path. If only light samples reach the light,
//! the path returns A = w_L K / p_L; if only BSDF samples do, B = w_B K / p_B. Hence w_L = A p_L / K and w_B = B p_B /
//! K can be measured for any scripted densities (see [`scenes`]). Means of pictures do not show them: these are right
//! for swapped or constant weights, too.
//!
//! Any partition of unity that increases with p_L / p_B passes. A regression of the logits shows what else the weights
//! depend on ([`form`]).

mod form;
mod only_way;
mod scenes;

use std::ops::RangeInclusive;

use arty::integrator::{Settings, Technique};
use arty::sampler::Sampler;
use harness::host_process::HostProcess;
use host::protocol::{ProbeJob, ProbedPath};
use verdict::check::{
    CheckKind, Evidence, MeasuredWeights, OnlyWayWeight, Reason, WeightFault, WeightForm, WeightTest, WhyNot,
};
use verdict::rubric::CheckSpec;

use super::{Check, CheckOutcome, GradeContext, JobError, Observation, Quantity, SceneWithReference};
use only_way::OnlyWayTest;
use scenes::MAX_LIGHTS;
pub(super) use scenes::{Configuration, ConfigurationRange, draw};

/// Tolerated deviation of the sum of the weights from one.
const TOLERATED: f64 = 1e-4;

/// Number of paths per scene for submissions without random decisions, and for others.
const FEW: u64 = 64;
const MANY: u64 = 16_384;

/// Number of standard errors that count as noise. One of a thousand comparisons exceeds it once in 500,000 runs.
const NOISE: f64 = 6.0;

/// Number of configurations with one vertex and moderate densities (for the regression), with one vertex and extreme
/// densities, and of each longer path.
const MODERATE: usize = 96;
const EXTREME: usize = 48;
const CHAINS: usize = 24;

/// The measured weights of one configuration.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reading {
    light: f64,
    bsdf: f64,
    /// Standard error of their sum.
    error: f64,
}

pub(super) struct MisWeights;

impl Check for MisWeights {
    fn kind(&self) -> CheckKind {
        CheckKind::MisWeights
    }

    fn techniques(&self) -> &'static [Technique] {
        &[Technique::Mis]
    }

    fn bounces(&self) -> RangeInclusive<u32> {
        1..=3
    }

    fn applies(&self, scene: &SceneWithReference, _: &CheckSpec) -> Result<(), WhyNot> {
        let features = scene.scene.features();
        if features.area_lights == 0 {
            Err(WhyNot::NothingToWeigh)
        } else if features.lit_surfaces == 0 {
            Err(WhyNot::NothingLit)
        } else {
            Ok(())
        }
    }

    fn run(&self, context: &GradeContext<'_>, spec: &CheckSpec) -> Result<CheckOutcome, JobError> {
        let (test, samples) = read_all(&mut context.start()?, spec, context.seed_of(spec))?;
        let reason = match test.fault {
            None => Reason::None,
            Some(WeightFault::NotANumber { .. }) => Reason::Numerics,
            Some(_) => Reason::Weights,
        };
        Ok(CheckOutcome::new(reason, Evidence::MisWeights(test), samples))
    }

    fn observations(&self, evidence: &Evidence) -> Vec<Observation> {
        let Evidence::MisWeights(WeightTest { measured: Some(measured), .. }) = evidence else {
            return Vec::new();
        };
        let mut all = Vec::new();
        for (of_light, form) in [(true, measured.light), (false, measured.bsdf)] {
            match form {
                WeightForm::Constant(value) => {
                    all.push(Observation::exact(Quantity::WeightConstant { of_light }, value));
                }
                WeightForm::Powers(exponents) => {
                    all.extend((0..).zip(exponents).map(|(factor, exponent)| {
                        Observation::exact(Quantity::WeightExponent { of_light, factor }, exponent)
                    }))
                }
                WeightForm::Other => {}
            }
        }
        let deviations =
            [(true, measured.deviation_at_first_vertex), (false, measured.deviation_at_later_vertices)];
        for (first_vertex, deviation) in deviations {
            let value = deviation.clamp(1e-4, 10.0).log10();
            all.push(Observation::exact(Quantity::WeightDeviation { first_vertex }, value));
        }
        let only_way =
            |it: &OnlyWayWeight| Some(Observation::exact(Quantity::OnlyWayWeight(it.light), it.weight?));
        all.extend(measured.only_way.iter().filter_map(only_way));
        all
    }
}

/// Measures the weights of all configurations. Also returns the number of paths.
fn read_all(process: &mut HostProcess, spec: &CheckSpec, seed: u64) -> Result<(WeightTest, u64), JobError> {
    let mut random = Sampler::new(seed, (0, 0), 0);
    let mut configurations = Vec::new();
    let mut add = |count: usize, range: ConfigurationRange| {
        configurations.extend((0..count).map(|_| (range.vertices, draw(range, &mut random))));
    };
    let moderate = ConfigurationRange { vertices: 1, densities: 1.5, distances: 1.1, min_cos: 0.1 };
    add(MODERATE, moderate);
    // e^27.6 is 10¹², e^3.9 is 50.
    add(EXTREME, ConfigurationRange { vertices: 1, densities: 27.6, distances: 3.9, min_cos: 0.05 });
    for vertices in 2..=spec.max_bounces as usize {
        add(CHAINS, ConfigurationRange { vertices, ..moderate });
    }

    let settings = Settings { technique: spec.technique, max_bounces: spec.max_bounces + 2 };
    let mut samples = FEW;
    loop {
        let mut ask =
            |scenes: Vec<_>| process.probe(&ProbeJob { settings, scenes, samples, seed, stratified: false });
        let mut readings = Vec::new();
        let mut varies = false;
        // A path tracer that samples all lights at each vertex has no selection probability in its densities.
        let mut samples_all_lights = true;
        for (vertices, configuration) in &configurations {
            let scenes = vec![configuration.light_side.clone(), configuration.bsdf_side.clone()];
            let paths = ask(scenes)?;
            if *vertices == 1 && configuration.lights == MAX_LIGHTS {
                samples_all_lights &= paths[0].iter().all(|path| path.light_samples as usize >= MAX_LIGHTS);
            }
            let Some(reading) = read(configuration, &paths) else {
                let Configuration { p_light: light, p_bsdf: bsdf, .. } = *configuration;
                let fault = Some(WeightFault::NotANumber { light, bsdf });
                return Ok((WeightTest { fault, measured: None }, 0));
            };
            varies |= reading.error > 0.01 * TOLERATED;
            readings.push(reading);
        }
        if varies && samples < MANY {
            samples = MANY;
            continue;
        }
        let only_way = only_way::measure(process, settings, samples, seed)?;
        if samples_all_lights {
            for (_, configuration) in &mut configurations {
                configuration.p_light *= configuration.lights as f64;
            }
        }
        let paths = samples * 2 * configurations.len() as u64;
        return Ok((judge(&configurations, &readings, only_way), paths));
    }
}

/// The weights of a configuration from the paths of its two scenes; `None` if a path returns NaN or infinity.
fn read(configuration: &Configuration, paths: &[Vec<ProbedPath>]) -> Option<Reading> {
    let side = |paths: &[ProbedPath], density: f64| {
        let (mean, error) = mean_and_error(paths)?;
        let scale = density / configuration.contribution;
        Some((mean * scale, error * scale))
    };
    let (light, light_error) = side(&paths[0], configuration.p_light)?;
    let (bsdf, bsdf_error) = side(&paths[1], configuration.p_bsdf)?;
    Some(Reading { light, bsdf, error: light_error.hypot(bsdf_error) })
}

/// Mean of the first channel and its standard error, which is 0 if the paths agree up to rounding; `None` if a path
/// returns NaN or infinity.
pub(super) fn mean_and_error(paths: &[ProbedPath]) -> Option<(f64, f64)> {
    if paths.iter().any(|path| path.radiance.iter().any(|value| !value.is_finite())) {
        return None;
    }
    let values = || paths.iter().map(|path| f64::from(path.radiance[0]));
    let count = paths.len() as f64;
    let mean = values().sum::<f64>() / count;
    let spread = values().map(|value| (value - mean).powi(2)).sum::<f64>() / (count - 1.0);
    let rounding = 1e-5 * mean.abs();
    Some((mean, if spread.sqrt() <= rounding { 0.0 } else { (spread / count).sqrt() }))
}

fn judge(
    configurations: &[(usize, Configuration)],
    readings: &[Reading],
    only_way: OnlyWayTest,
) -> WeightTest {
    let excess =
        |reading: &Reading| ((reading.light + reading.bsdf - 1.0).abs() - NOISE * reading.error).max(0.0);
    let worst = |readings: &[Reading]| readings.iter().map(excess).fold(0.0, f64::max);
    let single = configurations.iter().filter(|(vertices, _)| *vertices == 1).count();
    let (first, later) = readings.split_at(single);
    let moderate: Vec<(&Configuration, Reading)> =
        configurations.iter().map(|(_, it)| it).zip(readings.iter().copied()).take(MODERATE).collect();
    let sums = first.iter().map(|it| it.light + it.bsdf);
    let (min, max) = sums.fold((f64::INFINITY, 0.0f64), |(min, max), sum| (min.min(sum), max.max(sum)));
    let measured = MeasuredWeights {
        light: form::of(&moderate, |it| it.light),
        bsdf: form::of(&moderate, |it| 1.0 - it.bsdf),
        sum: [min, max],
        deviation_at_first_vertex: worst(first),
        deviation_at_later_vertices: worst(later),
        only_way: only_way.weights,
        points: points(&moderate),
    };
    let fault = if measured.deviation_at_first_vertex >= TOLERATED || !rises(&moderate) {
        Some(WeightFault::FirstVertex)
    } else if measured.deviation_at_later_vertices >= TOLERATED {
        Some(WeightFault::LaterVertices)
    } else {
        only_way.wrong.map(WeightFault::OnlyWay)
    };
    WeightTest { fault, measured: Some(measured) }
}

/// The weights over log₁₀ (p_L / p_B), for a plot; without points that are not finite.
fn points(moderate: &[(&Configuration, Reading)]) -> Vec<[f32; 3]> {
    let point = |(it, seen): &(&Configuration, Reading)| {
        [(it.p_light / it.p_bsdf).log10(), seen.light, seen.bsdf].map(|value| value as f32)
    };
    let mut points: Vec<[f32; 3]> = moderate.iter().map(point).collect();
    points.retain(|point| point.iter().all(|value| value.is_finite()));
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    points
}

/// True if the weight of light samples never decreases with p_L / p_B, and increases overall.
fn rises(moderate: &[(&Configuration, Reading)]) -> bool {
    let mut sorted: Vec<_> = moderate.iter().map(|(it, seen)| (it.p_light / it.p_bsdf, *seen)).collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut highest = Reading { light: f64::NEG_INFINITY, bsdf: 0.0, error: 0.0 };
    for (_, seen) in &sorted {
        if seen.light + TOLERATED + NOISE * seen.error.hypot(highest.error) < highest.light {
            return false;
        }
        if seen.light > highest.light {
            highest = *seen;
        }
    }
    match (sorted.first(), sorted.last()) {
        (Some((_, first)), Some((_, last))) => {
            last.light - first.light > 0.1 + NOISE * last.error.hypot(first.error)
        }
        _ => false,
    }
}
