//! MIS weights for densities near the limits of single precision.
//!
//! In each of two scripted scenes only one technique reaches the light (see
//! [`mis_weights`](crate::checks::mis_weights)). For all densities, the two contributions must correspond to weights
//! that sum to one.

use arty::integrator::Settings;
use arty::sampler::Sampler;
use host::protocol::{ProbeJob, ProbedPath, ScriptedScene};

use verdict::check::{Deviation, NumericalCause, Place, StabilityFinding};

use super::{PartResult, StabilityContext, is_radiance};
use crate::checks::mis_weights::{Configuration, ConfigurationRange, draw, mean_and_error};
use harness::host_process::HostProcess;

/// Number of paths per scene, for submissions with random decisions.
const PATHS: u64 = 256;

/// Tolerated deviation of the sum of the weights from one, and number of standard errors that count as noise.
const TOLERATED: f64 = 1e-3;
const NOISE: f64 = 7.0;

/// Densities are graded from the reciprocal of this up to this.
const GRADED_RANGE: f64 = 1.000_001e12;

/// Densities per solid angle. All pairs are tested.
const DENSITIES: [f64; 11] = [0.0, 1e-30, 1e-20, 1e-12, 1e-6, 1.0, 1e6, 1e12, 1e20, 1e30, f64::INFINITY];

/// Maximum throughput of a tested path.
const MAX_THROUGHPUT: f64 = 1e37;

/// The result for a pair of densities per solid angle.
struct Pair {
    light: f64,
    bsdf: f64,
    result: PairResult,
}

enum PairResult {
    Right,
    /// A path returned this value, which is not radiance. True for the light sample, false for the BSDF sample.
    NotRadiance(bool, f32),
    /// The weights have this sum.
    Sum(f64),
    /// A sample of infinite density contributes, although it should be divided by infinity.
    Bright,
}

pub(super) fn find(stability: &StabilityContext<'_>, process: &mut HostProcess) -> PartResult {
    let mut random = Sampler::new(stability.seed, (0, 0), 0);
    let (densities, distances, min_cos) = ([-1.0, 1.0], 0.1, 0.5);
    let range = ConfigurationRange { vertices: 1, densities, distances, min_cos, unequal: false };
    let configuration = draw(range, &mut random);
    let settings = Settings { max_bounces: 3, ..stability.settings };
    let mut pairs = Vec::new();
    for light in DENSITIES {
        for bsdf in DENSITIES {
            // Rounding must not decide which of two equal densities is greater.
            let bsdf = match bsdf == light {
                true if bsdf < 1.0 => 1.5 * bsdf,
                true => bsdf / 1.5,
                false => bsdf,
            };
            // The throughput f · cos / p_B must be representable in single precision.
            if bsdf > 0.0 && within_f32(light) / bsdf > MAX_THROUGHPUT {
                continue;
            }
            let scenes = scripted(&configuration, light, bsdf);
            let job = ProbeJob {
                settings,
                scenes: scenes.to_vec(),
                samples: PATHS,
                seed: stability.seed,
                stratified: false,
            };
            let paths = process.probe(&job)?;
            pairs.push(Pair { light, bsdf, result: evaluate(&configuration, light, bsdf, &paths) });
        }
    }
    let paths = 2 * PATHS * pairs.len() as u64;
    let (graded, beyond): (Vec<Pair>, Vec<Pair>) = pairs.into_iter().partition(|pair| {
        let inside = |density: f64| (1.0 / GRADED_RANGE..GRADED_RANGE).contains(&density);
        inside(pair.light) && inside(pair.bsdf)
    });
    let findings = [(graded, true), (beyond, false)];
    Ok((findings.iter().flat_map(|(pairs, is_graded)| describe(pairs, *is_graded)).collect(), paths))
}

/// The two scenes of a configuration with the given densities per solid angle.
fn scripted(configuration: &Configuration, light: f64, bsdf: f64) -> [ScriptedScene; 2] {
    let pdf_area = (light * per_area(configuration)) as f32;
    // With this value, each technique contributes 1 under the balance heuristic, whatever the densities.
    let value = (within_f32(light) + within_f32(bsdf)) / receiver_cos(configuration);
    [&configuration.light_side, &configuration.bsdf_side].map(|side| {
        let mut side = side.clone();
        for script in side.lights.iter_mut().flatten() {
            (script.pdf_area, script.pdf_area_on_hit) = (pdf_area, pdf_area);
        }
        for script in side.bsdfs.iter_mut().flatten() {
            (script.pdf, script.pdf_at_viewer, script.pdf_elsewhere) =
                (bsdf as f32, bsdf as f32, bsdf as f32);
            script.f = value as f32;
        }
        side
    })
}

/// Density per area of a light point whose density per solid angle, including the selection probability, is 1.
fn per_area(configuration: &Configuration) -> f64 {
    configuration.lights as f64 * configuration.cos_light / configuration.distance.powi(2)
}

/// Cosine at the receiver: contribution f · L · cos of the original configuration divided by f, with L = 1.
fn receiver_cos(configuration: &Configuration) -> f64 {
    let f = configuration.light_side.bsdfs.iter().flatten().next().map_or(1.0, |script| f64::from(script.f));
    configuration.contribution / f
}

fn within_f32(density: f64) -> f64 {
    density.min(1e30)
}

fn evaluate(configuration: &Configuration, light: f64, bsdf: f64, paths: &[Vec<ProbedPath>]) -> PairResult {
    let [sampled, hit] = paths else { return PairResult::NotRadiance(true, f32::NAN) };
    // A sample of density 0 is never drawn, so that its path need not be valid.
    let drawn = [(true, sampled, light), (false, hit, bsdf)];
    for (of_light_sample, paths, _) in drawn.into_iter().filter(|(.., density)| *density > 0.0) {
        let bad = paths.iter().flat_map(|path| path.radiance).find(|&value| !is_radiance(value));
        if let Some(value) = bad {
            return PairResult::NotRadiance(of_light_sample, value);
        }
    }
    let mean = |paths: &[ProbedPath]| mean_and_error(paths).unwrap_or((0.0, 0.0));
    let (sampled, hit) = (mean(sampled), mean(hit));
    let contribution =
        receiver_cos(configuration) * ((within_f32(light) + within_f32(bsdf)) / receiver_cos(configuration));
    // A sample of density 0 is never drawn, and one of infinite density contributes nothing.
    let taken = |density: f64| density > 0.0 && density.is_finite();
    if !taken(light) || !taken(bsdf) {
        let dark = [(light, sampled.0), (bsdf, hit.0)];
        let bright = dark.into_iter().any(|(density, mean)| density.is_infinite() && mean > 1e-3);
        return if bright { PairResult::Bright } else { PairResult::Right };
    }
    let sum = sampled.0 * light / contribution + hit.0 * bsdf / contribution;
    let noise = NOISE * (sampled.1 * light / contribution).hypot(hit.1 * bsdf / contribution);
    if (sum - 1.0).abs() <= TOLERATED + noise { PairResult::Right } else { PairResult::Sum(sum) }
}

/// One finding for each kind of failure: the first such pair and the number of pairs.
fn describe(pairs: &[Pair], is_graded: bool) -> Vec<StabilityFinding> {
    let of = |fails: fn(&PairResult) -> bool| {
        let all: Vec<&Pair> = pairs.iter().filter(|pair| fails(&pair.result)).collect();
        let first = *all.first()?;
        let pairs = [all.len() as u32, pairs.len() as u32];
        let (deviation, likely_cause) = match first.result {
            PairResult::NotRadiance(of_light_sample, value) => {
                (Deviation::NoRadiance { of_light_sample, value: value.into(), pairs }, cause(first))
            }
            PairResult::Sum(sum) => {
                (Deviation::WeightSum { sum: sum.into(), pairs }, cause_of_sum(first, sum))
            }
            PairResult::Right | PairResult::Bright => {
                (Deviation::InfiniteDensityContributes { pairs }, NumericalCause::InfinityOverInfinity)
            }
        };
        let place = Place::Densities { light: first.light.into(), bsdf: first.bsdf.into() };
        Some(StabilityFinding { place, deviation, likely_cause, is_graded, first: None, replay: None })
    };
    let kinds: [fn(&PairResult) -> bool; 3] = [
        |result| matches!(result, PairResult::NotRadiance(..)),
        |result| matches!(result, PairResult::Sum(_)),
        |result| matches!(result, PairResult::Bright),
    ];
    kinds.into_iter().filter_map(of).collect()
}

/// The most frequent cause of NaN or infinity at such densities.
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
