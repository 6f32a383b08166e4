//! **mis-weights**: do the weights of the two techniques sum to one, and do they rise with the right densities?
//!
//! K = f · L · cos θ is what one light point can send along one path. If only light samples arrive the path finds
//! A = w_L K / p_L, if only BSDF samples do B = w_B K / p_B; so w_L = A p_L / K and w_B = B p_B / K can be read off, for
//! any densities that a script names (see [`scenes`]). The mean of a picture cannot show them: with swapped or constant
//! weights it is right too.
//!
//! Any partition of unity that rises with p_L / p_B passes. What else the weights depend on shows in a regression of
//! their logits ([`exponents`]).

mod exponents;
mod scenes;
mod special;

use std::collections::BTreeMap;

use arty::integrator::Settings;
use arty::sampler::Sampler;
use host::protocol::{ProbeJob, ProbedPath};
use verdict::report::{CONSTANT_WEIGHTS, Weights};

use super::{Bench, Stop};
use exponents::Side;
use harness::host_process::HostProcess;
use scenes::MANY_LIGHTS;
pub(super) use scenes::{Configuration, Plan, draw};
use special::Special;
use verdict::report::{CheckResult, Reason, Verdict};
use verdict::rubric::CheckSpec;

/// How far the sum of two weights may be from one.
const TOLERATED: f64 = 1e-4;

/// Paths in each scene, if the hand-in decides nothing by chance; and otherwise.
const FEW: u64 = 64;
const MANY: u64 = 16_384;

/// How many standard errors are noise. Of a thousand comparisons one is beyond that once in 500,000 runs.
const NOISE: f64 = 6.0;

/// Configurations of moderate densities at one vertex (for the regression), of extreme ones, of each longer chain.
const MODERATE: usize = 96;
const EXTREME: usize = 48;
const CHAINS: usize = 24;

/// The outcome, to be put into the check's result.
struct Outcome {
    verdict: Verdict,
    reason: Reason,
    explanation: String,
    weights: Option<Weights>,
    details: BTreeMap<String, f64>,
    samples: u64,
}

impl Outcome {
    fn fail(reason: Reason, explanation: String) -> Self {
        Self {
            verdict: Verdict::Fail,
            reason,
            explanation,
            weights: None,
            details: BTreeMap::new(),
            samples: 0,
        }
    }
}

/// The weights of one configuration.
#[derive(Clone, Copy, Debug)]
pub(super) struct Observation {
    light: f64,
    bsdf: f64,
    /// Standard error of their sum.
    error: f64,
}

pub(super) fn run(bench: &Bench<'_>, spec: &CheckSpec, result: &mut CheckResult) -> Result<(), Stop> {
    let outcome = observe_all(&mut bench.start()?, spec, bench.seed_of(spec))?;
    result.verdict = outcome.verdict;
    result.reason = outcome.reason;
    result.explanation = outcome.explanation;
    result.weights = outcome.weights;
    result.details = outcome.details;
    result.samples = outcome.samples;
    Ok(())
}

fn observe_all(process: &mut HostProcess, spec: &CheckSpec, seed: u64) -> Result<Outcome, Stop> {
    let mut random = Sampler::new(seed, (0, 0), 0);
    let mut configurations = Vec::new();
    let mut add = |count: usize, plan: Plan| {
        configurations.extend((0..count).map(|_| (plan.vertices, draw(plan, &mut random))));
    };
    let moderate = Plan { vertices: 1, densities: 1.5, distances: 1.1, least_cos: 0.1 };
    add(MODERATE, moderate);
    // e^27.6 is 10¹², e^3.9 is 50.
    add(EXTREME, Plan { vertices: 1, densities: 27.6, distances: 3.9, least_cos: 0.05 });
    for vertices in 2..=spec.max_bounces as usize {
        add(CHAINS, Plan { vertices, ..moderate });
    }

    let settings = Settings { technique: spec.technique, max_bounces: spec.max_bounces + 2 };
    let mut samples = FEW;
    loop {
        let mut ask =
            |scenes: Vec<_>| process.probe(&ProbeJob { settings, scenes, samples, seed, stratified: false });
        let mut observations = Vec::new();
        let mut varies = false;
        // Who asks every light picks none: then the density of a light sample has no probability of the pick in it.
        let mut all_asked = true;
        for (vertices, configuration) in &configurations {
            let scenes = vec![configuration.light_side.clone(), configuration.bsdf_side.clone()];
            let paths = ask(scenes)??;
            if *vertices == 1 && configuration.lights == MANY_LIGHTS {
                all_asked &= paths[0].iter().all(|path| path.light_samples as usize >= MANY_LIGHTS);
            }
            match observe(configuration, &paths) {
                Ok(observation) => {
                    varies |= observation.error > 0.01 * TOLERATED;
                    observations.push(observation);
                }
                Err(explanation) => return Ok(Outcome::fail(Reason::Numerics, explanation)),
            }
        }
        if varies && samples < MANY {
            samples = MANY;
            continue;
        }
        let special = special::look(process, settings, samples, seed)?;
        if all_asked {
            for (_, configuration) in &mut configurations {
                configuration.p_light *= configuration.lights as f64;
            }
        }
        let mut outcome = judge(&configurations, &observations, &special);
        outcome.samples = samples * 2 * configurations.len() as u64;
        return Ok(outcome);
    }
}

/// Reads the weights off the paths of both scenes of a configuration.
fn observe(
    configuration: &Configuration,
    paths: &[Vec<ProbedPath>],
) -> std::result::Result<Observation, String> {
    let side = |paths: &[ProbedPath], density: f64| {
        let (mean, error) = mean_and_error(paths).ok_or_else(|| {
            format!(
                "a path gives NaN or infinity where the densities per solid angle are {:.1e} (light) and {:.1e} (BSDF)",
                configuration.p_light, configuration.p_bsdf
            )
        })?;
        let scale = density / configuration.contribution;
        Ok::<_, String>((mean * scale, error * scale))
    };
    let (light, light_error) = side(&paths[0], configuration.p_light)?;
    let (bsdf, bsdf_error) = side(&paths[1], configuration.p_bsdf)?;
    Ok(Observation { light, bsdf, error: light_error.hypot(bsdf_error) })
}

/// Mean of the first channel and its standard error, which is 0 if the paths agree but for rounding; `None` if a path
/// gives no number.
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
    observations: &[Observation],
    special: &Special,
) -> Outcome {
    let excess = |observation: &Observation| {
        ((observation.light + observation.bsdf - 1.0).abs() - NOISE * observation.error).max(0.0)
    };
    let worst = |observations: &[Observation]| observations.iter().map(excess).fold(0.0, f64::max);
    let single = configurations.iter().filter(|(vertices, _)| *vertices == 1).count();
    let moderate: Vec<(&Configuration, Observation)> =
        configurations.iter().map(|(_, it)| it).zip(observations.iter().copied()).take(MODERATE).collect();
    let light = Side::of(&moderate, |it| it.light);
    let bsdf = Side::of(&moderate, |it| 1.0 - it.bsdf);
    let weights = Weights {
        largest_deviation: worst(observations),
        light_exponents: light.exponents(),
        bsdf_exponents: bsdf.exponents(),
        measured: measured(&moderate),
    };
    let mut details = special.weights.clone();
    details.insert("deviation at the first vertex".to_owned(), worst(&observations[..single]));
    details.insert("deviation at later vertices".to_owned(), worst(&observations[single..]));
    for (name, side) in CONSTANT_WEIGHTS.into_iter().zip([&light, &bsdf]) {
        if let Side::Constant(value) = side {
            details.insert(name.to_owned(), *value);
        }
    }
    let sums_to_one = worst(&observations[..single]) < TOLERATED;
    let verdict = if sums_to_one && rises(&moderate) {
        if worst(&observations[single..]) >= TOLERATED {
            Err("the weights are right at the first vertex of a path and wrong at later ones: what is remembered of \
                 the last bounce is not that of the last bounce"
                .to_owned())
        } else if let Some(complaint) = &special.complaint {
            Err(complaint.clone())
        } else {
            Ok(exponents::remark(&light, weights.largest_deviation))
        }
    } else {
        let sum = if sums_to_one {
            String::new()
        } else {
            let (least, most) = observations[..single]
                .iter()
                .map(|it| it.light + it.bsdf)
                .fold((f64::INFINITY, 0.0f64), |(least, most), sum| (least.min(sum), most.max(sum)));
            format!("the two weights of a path sum to {least:.3} to {most:.3} instead of 1; ")
        };
        Err(format!("{sum}{}", exponents::explain(&light, &bsdf)))
    };
    let (verdict, reason, explanation) = match verdict {
        Ok(remark) => (Verdict::Pass, Reason::None, remark),
        Err(complaint) => (Verdict::Fail, Reason::Weights, complaint),
    };
    Outcome { verdict, reason, explanation, weights: Some(weights), details, samples: 0 }
}

/// The weights over log₁₀ (p_L / p_B), for a plot; what is no number is left out.
fn measured(moderate: &[(&Configuration, Observation)]) -> Vec<[f32; 3]> {
    let point = |(it, seen): &(&Configuration, Observation)| {
        [(it.p_light / it.p_bsdf).log10(), seen.light, seen.bsdf].map(|value| value as f32)
    };
    let mut points: Vec<[f32; 3]> = moderate.iter().map(point).collect();
    points.retain(|point| point.iter().all(|value| value.is_finite()));
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    points
}

/// True if the weight of light samples never falls as p_L / p_B rises, and rises somewhere.
fn rises(moderate: &[(&Configuration, Observation)]) -> bool {
    let mut sorted: Vec<_> = moderate.iter().map(|(it, seen)| (it.p_light / it.p_bsdf, *seen)).collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut highest = Observation { light: f64::NEG_INFINITY, bsdf: 0.0, error: 0.0 };
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
