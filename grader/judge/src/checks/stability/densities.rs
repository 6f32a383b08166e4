//! Weights for densities at the ends of what single precision holds.
//!
//! In a scripted scene the light can be reached in one way only (see [`mis_weights`](crate::checks::mis_weights)), and
//! whatever the densities are, both ways together must bring f · L · cos / (p_L + p_B) twice over their weights' sum.

use arty::integrator::Settings;
use arty::sampler::Sampler;
use host::protocol::{ProbeJob, ProbedPath, ScriptedScene};

use verdict::check::{Deviation, NumericalCause, Place, StabilityFinding};

use super::{Asked, Found};
use crate::checks::mis_weights::{Configuration, Plan, draw, mean_and_error};
use harness::host_process::HostProcess;

/// Paths in each scene, for submissions that decide something by chance.
const PATHS: u64 = 256;

/// How far the sum of two weights may be from one, beyond noise.
const TOLERATED: f64 = 1e-3;
const NOISE: f64 = 7.0;

/// Densities of this many decades on either side of 1 are in the range that is judged.
const JUDGED: f64 = 1.000_001e12;

/// Densities that are paired, all with all.
const DENSITIES: [f64; 11] = [0.0, 1e-30, 1e-20, 1e-12, 1e-6, 1.0, 1e6, 1e12, 1e20, 1e30, f64::INFINITY];

/// The greatest throughput of a path that is asked for.
const MOST_THROUGHPUT: f64 = 1e37;

/// A pair of densities with what came of it.
struct Pair {
    light: f64,
    bsdf: f64,
    outcome: Outcome,
}

enum Outcome {
    Right,
    /// True in the light sample, false in the BSDF sample: the radiance of the path.
    NoRadiance(bool, f32),
    /// The sum of the weights.
    Sum(f64),
    /// Light where there should be none: the infinite density's reciprocal is 0.
    Bright,
}

pub(super) fn find(asked: &Asked<'_>, process: &mut HostProcess) -> Found {
    let mut random = Sampler::new(asked.seed, (0, 0), 0);
    let plan = Plan { vertices: 1, densities: 1.0, distances: 0.1, least_cos: 0.5 };
    let configuration = draw(plan, &mut random);
    let settings = Settings { max_bounces: 3, ..asked.settings };
    let mut pairs = Vec::new();
    for light in DENSITIES {
        for bsdf in DENSITIES {
            // The path goes on with f · cos / p_B, which single precision has to hold, or nobody could be right.
            if bsdf > 0.0 && within_f32(light) / bsdf > MOST_THROUGHPUT {
                continue;
            }
            let scenes = scripted(&configuration, light, bsdf);
            let job = ProbeJob {
                settings,
                scenes: scenes.to_vec(),
                samples: PATHS,
                seed: asked.seed,
                stratified: false,
            };
            let paths = process.probe(&job)?;
            pairs.push(Pair { light, bsdf, outcome: judge(&configuration, light, bsdf, &paths) });
        }
    }
    let paths = 2 * PATHS * pairs.len() as u64;
    let (judged, beyond): (Vec<Pair>, Vec<Pair>) = pairs.into_iter().partition(|pair| {
        let inside = |density: f64| (1.0 / JUDGED..JUDGED).contains(&density);
        inside(pair.light) && inside(pair.bsdf)
    });
    let findings = [(judged, true), (beyond, false)];
    Ok((findings.iter().flat_map(|(pairs, is_graded)| describe(pairs, *is_graded)).collect(), paths))
}

/// Both scenes of the configuration with other densities per solid angle.
fn scripted(configuration: &Configuration, light: f64, bsdf: f64) -> [ScriptedScene; 2] {
    let pdf_area = (light * per_area(configuration)) as f32;
    // Then each weight of the balance heuristic brings 1, whatever the densities; an end of the range brings little.
    let value = (within_f32(light) + within_f32(bsdf)) / receiver_cos(configuration);
    [&configuration.light_side, &configuration.bsdf_side].map(|side| {
        let mut side = side.clone();
        for script in side.lights.iter_mut().flatten() {
            script.pdf_area = pdf_area;
        }
        for script in side.bsdfs.iter_mut().flatten() {
            script.pdf = bsdf as f32;
            script.f = value as f32;
        }
        side
    })
}

/// Density per area for a density of 1 per solid angle, with the probability of picking the light.
fn per_area(configuration: &Configuration) -> f64 {
    configuration.lights as f64 * configuration.cos_light / configuration.distance.powi(2)
}

/// f · L · cos of the configuration as it was drawn, divided by its f: L is 1.
fn receiver_cos(configuration: &Configuration) -> f64 {
    let f = configuration.light_side.bsdfs.iter().flatten().next().map_or(1.0, |script| f64::from(script.f));
    configuration.contribution / f
}

fn within_f32(density: f64) -> f64 {
    density.min(1e30)
}

fn judge(configuration: &Configuration, light: f64, bsdf: f64, paths: &[Vec<ProbedPath>]) -> Outcome {
    let [sampled, hit] = paths else { return Outcome::NoRadiance(true, f32::NAN) };
    // What has the density 0 is never drawn, so that nobody has to divide by it.
    let drawn = [(true, sampled, light), (false, hit, bsdf)];
    for (way, paths, _) in drawn.into_iter().filter(|(.., density)| *density > 0.0) {
        let bad =
            paths.iter().flat_map(|path| path.radiance).find(|value| !(value.is_finite() && *value >= 0.0));
        if let Some(value) = bad {
            return Outcome::NoRadiance(way, value);
        }
    }
    let mean = |paths: &[ProbedPath]| mean_and_error(paths).unwrap_or((0.0, 0.0));
    let (sampled, hit) = (mean(sampled), mean(hit));
    let contribution =
        receiver_cos(configuration) * ((within_f32(light) + within_f32(bsdf)) / receiver_cos(configuration));
    // A way whose density is 0 is never taken, and one whose density is infinite brings nothing.
    let taken = |density: f64| density > 0.0 && density.is_finite();
    if !taken(light) || !taken(bsdf) {
        let dark = [(light, sampled.0), (bsdf, hit.0)];
        let bright = dark.into_iter().any(|(density, mean)| density.is_infinite() && mean > 1e-3);
        return if bright { Outcome::Bright } else { Outcome::Right };
    }
    let sum = sampled.0 * light / contribution + hit.0 * bsdf / contribution;
    let noise = NOISE * (sampled.1 * light / contribution).hypot(hit.1 * bsdf / contribution);
    if (sum - 1.0).abs() <= TOLERATED + noise { Outcome::Right } else { Outcome::Sum(sum) }
}

/// One finding for all pairs that fail alike: the first of them, and how many there are.
fn describe(pairs: &[Pair], is_graded: bool) -> Vec<StabilityFinding> {
    let of = |fails: fn(&Outcome) -> bool| {
        let all: Vec<&Pair> = pairs.iter().filter(|pair| fails(&pair.outcome)).collect();
        let first = *all.first()?;
        let pairs = [all.len() as u32, pairs.len() as u32];
        let (deviation, likely_cause) = match first.outcome {
            Outcome::NoRadiance(of_light_sample, value) => {
                (Deviation::NoRadiance { of_light_sample, value: value.into(), pairs }, cause(first))
            }
            Outcome::Sum(sum) => (Deviation::WeightSum { sum: sum.into(), pairs }, cause_of_sum(first, sum)),
            Outcome::Right | Outcome::Bright => {
                (Deviation::InfiniteDensityContributes { pairs }, NumericalCause::InfinityOverInfinity)
            }
        };
        let place = Place::Densities { light: first.light.into(), bsdf: first.bsdf.into() };
        Some(StabilityFinding { place, deviation, likely_cause, is_graded, first: None, replay: None })
    };
    let kinds: [fn(&Outcome) -> bool; 3] = [
        |outcome| matches!(outcome, Outcome::NoRadiance(..)),
        |outcome| matches!(outcome, Outcome::Sum(_)),
        |outcome| matches!(outcome, Outcome::Bright),
    ];
    kinds.into_iter().filter_map(of).collect()
}

/// What makes NaN or infinity of such operands.
fn cause(pair: &Pair) -> NumericalCause {
    let (min, max) = (pair.light.min(pair.bsdf), pair.light.max(pair.bsdf));
    if max == 0.0 {
        NumericalCause::BothDensitiesZero
    } else if max.is_infinite() {
        NumericalCause::InfiniteDensity
    } else if min == 0.0 {
        NumericalCause::OtherDensityZero
    } else if max > 1e19 {
        NumericalCause::DensityOverflow
    } else if min < 1e-19 {
        NumericalCause::DensityUnderflow
    } else {
        NumericalCause::DensityRange
    }
}

fn cause_of_sum(pair: &Pair, sum: f64) -> NumericalCause {
    if sum > 1.5 {
        NumericalCause::OverflowPatchedToOne
    } else if pair.light.max(pair.bsdf) > 1e19 || pair.light.min(pair.bsdf) < 1e-19 {
        NumericalCause::DensityNanHidden
    } else {
        NumericalCause::ClampedDensities
    }
}
