//! **mis-weights**: do the MIS weights sum to one, and do they depend on the right densities?
//!
//! Let K = f · L · cos θ be the contribution of one light point along one path. If only light samples reach the light,
//! the path returns A = w_L K / p_L; if only BSDF samples do, B = w_B K / p_B. Hence w_L = A p_L / K and w_B = B p_B /
//! K can be measured for any scripted densities (see [`scenes`]). Means of pictures do not show them: these are right
//! for swapped or constant weights, too.
//!
//! Any partition of unity that increases with p_L / p_B passes. A regression of the logits shows what else the weights
//! depend on ([`form`]).
//!
//! Densities are ordinary ones: 1e-3 to 1e4 per solid angle and per area. Those beyond are left to `stability`, since a constant that
//! guards a denominator changes hardly any picture.

mod form;
mod only_way;
mod scenes;

use std::ops::RangeInclusive;

use arty::integrator::{Settings, Technique};
use arty::sampler::{Sampler, batch_seed};
use harness::host_process::HostProcess;
use host::protocol::{ProbeJob, ProbedPath, ScriptedScene};
use verdict::check::{
    CheckKind, Evidence, MeasuredWeights, OnlyWay, OnlyWayWeight, Reason, WeightFault, WeightForm,
    WeightTest, WhyNot,
};
use verdict::rubric::CheckSpec;

use super::{Check, CheckOutcome, GradeContext, JobError, Observation, Quantity, SceneWithReference};
use only_way::OnlyWayTest;
use scenes::MAX_LIGHTS;
pub(super) use scenes::{Configuration, ConfigurationRange, draw};

/// Tolerated deviation of the sum of the weights from one: that of weights in half precision, and more.
const TOLERATED: f64 = 1e-3;

/// Relative standard error below which a contribution counts as constant.
const EXACT: f64 = 1e-6;

/// Number of paths per scene: where paths agree, where they differ by random decisions of the submission, and where one
/// of several lights has to be selected. Long paths may end by Russian roulette: of `SOME` paths in each of 8 scenes, each
/// with a seed of its own, all survive a probability of 0.998 once in 3,600 runs, and one of 0.99 never.
const FEW: u64 = 64;
const SOME: u64 = 512;
const MANY: u64 = 8192;
const MOST: u64 = 16_384;

/// Number of standard errors that count as noise. One of a thousand comparisons exceeds it once in 500,000 runs.
const NOISE: f64 = 6.0;

/// Number of configurations with one vertex and moderate densities (for the regression), with one vertex and a wide range
/// of densities, with lights of unequal power, of each longer path, and of each path with more vertices than
/// `max_bounces`, up to [`LONGEST`].
const MODERATE: usize = 96;
const WIDE: usize = 48;
const UNEQUAL: usize = 12;
const CHAINS: usize = 24;
const LONG_CHAINS: usize = 8;

/// Ordinary densities, per solid angle and per area.
const ORDINARY: RangeInclusive<f64> = 1e-3..=1e4;

/// Maximum number of vertices of a path before the light.
const LONGEST: usize = 6;

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
        let only_way = |it: &OnlyWayWeight| {
            let weight = it.weight?;
            // Mistakes with a weight of 1 here do not differ in it.
            let is_news = it.light != OnlyWay::AfterLight || (weight - 1.0).abs() > TOLERATED;
            is_news.then(|| Observation::exact(Quantity::OnlyWayWeight(it.light), weight))
        };
        all.extend(measured.only_way.iter().filter_map(only_way));
        all
    }
}

/// Measures the weights of all configurations. Also returns the number of paths.
fn read_all(process: &mut HostProcess, spec: &CheckSpec, seed: u64) -> Result<(WeightTest, u64), JobError> {
    let configurations = configurations(spec, seed);
    let settings = Settings { technique: spec.technique, max_bounces: LONGEST as u32 + 2 };
    let mut meter =
        Meter { process, settings, seed, samples: FEW, paths: 0, traced: 0, asks_all_lights: true };
    let mut readings = Vec::new();
    for group in configurations.chunk_by(|(a, _), (b, _)| a == b) {
        match meter.read_all(group)? {
            Ok(of_group) => readings.extend(of_group),
            Err(fault) => return Ok((WeightTest { fault: Some(fault), measured: None }, meter.paths)),
        }
    }
    let Meter { samples, paths, asks_all_lights, .. } = meter;
    let only_way = only_way::measure(process, settings, samples, seed)?;
    Ok((judge(&configurations, &readings, asks_all_lights, only_way), paths))
}

/// The configurations with their numbers of vertices: first those with one vertex, of which the first [`MODERATE`] have
/// moderate densities.
fn configurations(spec: &CheckSpec, seed: u64) -> Vec<(usize, Configuration)> {
    let mut random = Sampler::new(seed, (0, 0), 0);
    // e^1.5 is 4.5; the logarithms of `ORDINARY` are -6.9 and 9.2.
    let moderate = ConfigurationRange {
        vertices: 1,
        densities: [-1.5, 1.5],
        distances: 1.1,
        min_cos: 0.1,
        unequal: false,
    };
    let wide = ConfigurationRange { densities: [-6.9, 9.2], distances: 2.0, min_cos: 0.05, ..moderate };
    let mut ranges = vec![(MODERATE, moderate), (WIDE, wide)];
    ranges.push((UNEQUAL, ConfigurationRange { unequal: true, ..moderate }));
    for vertices in 2..=LONGEST {
        let count = if vertices <= spec.max_bounces as usize { CHAINS } else { LONG_CHAINS };
        ranges.push((count, ConfigurationRange { vertices, ..moderate }));
    }
    let all = ranges.into_iter().flat_map(|(count, range)| std::iter::repeat_n(range, count));
    let mut draw_ordinary = |range| {
        loop {
            let configuration = draw(range, &mut random);
            if ORDINARY.contains(&(1.0 / configuration.area)) {
                return configuration;
            }
        }
    };
    all.map(|range| (range.vertices, draw_ordinary(range))).collect()
}

/// Measures weights with as many paths as needed.
struct Meter<'a> {
    process: &'a mut HostProcess,
    settings: Settings,
    seed: u64,
    /// Minimum number of paths per scene: raised once paths have differed.
    samples: u64,
    /// Number of all paths so far.
    paths: u64,
    /// Number of scenes traced so far: each has random numbers of its own, so that paths do not agree by chance in all of
    /// them at once.
    traced: u64,
    /// True as long as every path has asked each light for a sample.
    asks_all_lights: bool,
}

impl Meter<'_> {
    /// The weights of configurations with the same number of vertices; a fault if a path returns NaN or infinity.
    fn read_all(
        &mut self,
        group: &[(usize, Configuration)],
    ) -> Result<Result<Vec<Reading>, WeightFault>, JobError> {
        loop {
            let samples = self.samples;
            let mut readings = Vec::with_capacity(group.len());
            for (vertices, configuration) in group {
                let Some(reading) = self.read(*vertices, configuration)? else {
                    let Configuration { p_light: light, p_bsdf: bsdf, .. } = *configuration;
                    return Ok(Err(WeightFault::NotANumber { light, bsdf }));
                };
                readings.push(reading);
            }
            // Where some paths differ, the few paths of other configurations may agree by chance.
            if self.samples == samples {
                return Ok(Ok(readings));
            }
        }
    }

    /// The weights of a configuration; `None` if a path returns NaN or infinity.
    fn read(&mut self, vertices: usize, configuration: &Configuration) -> Result<Option<Reading>, JobError> {
        let selects = configuration.visible_lights < configuration.lights;
        let alike = if vertices > 3 { SOME } else { FEW };
        let light_paths = self.trace(&configuration.light_side, if selects { MOST } else { alike })?;
        let bsdf_paths = self.trace(&configuration.bsdf_side, alike)?;
        if vertices == 1 && configuration.lights == MAX_LIGHTS {
            self.asks_all_lights &= light_paths.iter().all(|path| path.light_samples as usize >= MAX_LIGHTS);
        }
        // With several equal lights, each contributes. With a selection probability of the submission's own, it cancels
        // with the frequency of selection.
        let equal_lights = configuration.lights as f64 / configuration.visible_lights as f64;
        let side = |paths: &[ProbedPath], density: f64| {
            let (mean, error) = mean_and_error(paths)?;
            let scale = density / configuration.contribution;
            Some((mean * scale, error * scale))
        };
        let reading = || {
            let (light, light_error) = side(&light_paths, configuration.p_light * equal_lights)?;
            let (bsdf, bsdf_error) = side(&bsdf_paths, configuration.p_bsdf)?;
            Some(Reading { light, bsdf, error: light_error.hypot(bsdf_error) })
        };
        Ok(reading())
    }

    /// Traces at least this number of paths, and more if they differ.
    fn trace(&mut self, scene: &ScriptedScene, min: u64) -> Result<Vec<ProbedPath>, JobError> {
        loop {
            let (settings, samples) = (self.settings, self.samples.max(min));
            let seed = batch_seed(self.seed, self.traced);
            self.traced += 1;
            let job = ProbeJob { settings, scenes: vec![scene.clone()], samples, seed, stratified: false };
            let paths = self.process.probe(&job)?.pop().unwrap_or_default();
            self.paths += samples;
            let differ = mean_and_error(&paths).is_some_and(|(mean, error)| error > EXACT * mean.abs());
            if !differ || samples >= MANY {
                return Ok(paths);
            }
            self.samples = MANY;
        }
    }
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
    asks_all_lights: bool,
    only_way: OnlyWayTest,
) -> WeightTest {
    let excess =
        |reading: &Reading| ((reading.light + reading.bsdf - 1.0).abs() - NOISE * reading.error).max(0.0);
    let worst = |readings: &[Reading]| readings.iter().map(excess).fold(0.0, f64::max);
    let single = configurations.iter().filter(|(vertices, _)| *vertices == 1).count();
    let (first, later) = readings.split_at(single);
    let moderate: Vec<(Configuration, Reading)> = configurations
        .iter()
        .map(|(_, it)| it.clone())
        .zip(readings.iter().copied())
        .take(MODERATE)
        .collect();
    // A path tracer that samples all lights at each vertex has no selection probability in its densities. One that asks
    // all of them may also do so in order to select one.
    let without_selection = || -> Vec<(Configuration, Reading)> {
        let density = |it: &Configuration| it.p_light * it.lights as f64;
        moderate
            .iter()
            .map(|(it, seen)| (Configuration { p_light: density(it), ..it.clone() }, *seen))
            .collect()
    };
    let (moderate, rises) = match rises(&moderate) {
        true => (moderate, true),
        false if asks_all_lights && rises(&without_selection()) => (without_selection(), true),
        false => (moderate, false),
    };
    // Those of unequal lights are noisy.
    let sums = first.iter().take(MODERATE + WIDE).map(|it| it.light + it.bsdf);
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
    let fault = if measured.deviation_at_first_vertex >= TOLERATED || !rises {
        Some(WeightFault::FirstVertex)
    } else if measured.deviation_at_later_vertices >= TOLERATED {
        Some(WeightFault::LaterVertices)
    } else {
        only_way.wrong.map(WeightFault::OnlyWay)
    };
    WeightTest { fault, measured: Some(measured) }
}

/// The weights over log₁₀ (p_L / p_B), for a plot; without points that are not finite.
fn points(moderate: &[(Configuration, Reading)]) -> Vec<[f32; 3]> {
    let point = |(it, seen): &(Configuration, Reading)| {
        [(it.p_light / it.p_bsdf).log10(), seen.light, seen.bsdf].map(|value| value as f32)
    };
    let mut points: Vec<[f32; 3]> = moderate.iter().map(point).collect();
    points.retain(|point| point.iter().all(|value| value.is_finite()));
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    points
}

/// True if the weight of light samples never decreases with p_L / p_B, and increases overall.
fn rises(moderate: &[(Configuration, Reading)]) -> bool {
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
