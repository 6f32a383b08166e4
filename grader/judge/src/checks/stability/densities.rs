//! Weights for densities at the ends of what single precision holds.
//!
//! In a scripted scene the light can be reached in one way only (see [`mis_weights`](crate::checks::mis_weights)), and
//! whatever the densities are, both ways together must bring f · L · cos / (p_L + p_B) twice over their weights' sum.

use arty::integrator::Settings;
use arty::sampler::Sampler;
use host::protocol::{ProbeJob, ProbedPath, ScriptedScene};

use super::{Asked, Finding, Found};
use crate::checks::mis_weights::{Configuration, Plan, draw, mean_and_error};
use harness::host_process::HostProcess;

/// Paths in each scene, for hand-ins that decide something by chance.
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
    /// In the light sample or in the BSDF sample: the radiance of the path.
    NoRadiance(&'static str, f32),
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
            let paths = match process.probe(&job)? {
                Ok(paths) => paths,
                Err(fault) => return Ok(Err(fault)),
            };
            pairs.push(Pair { light, bsdf, outcome: judge(&configuration, light, bsdf, &paths) });
        }
    }
    let paths = 2 * PATHS * pairs.len() as u64;
    let (judged, beyond): (Vec<Pair>, Vec<Pair>) = pairs.into_iter().partition(|pair| {
        let inside = |density: f64| (1.0 / JUDGED..JUDGED).contains(&density);
        inside(pair.light) && inside(pair.bsdf)
    });
    let findings = [(judged, true), (beyond, false)];
    Ok(Ok((findings.iter().flat_map(|(pairs, judged)| describe(pairs, *judged)).collect(), paths)))
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
    let [sampled, hit] = paths else { return Outcome::NoRadiance("an answer", f32::NAN) };
    // What has the density 0 is never drawn, so that nobody has to divide by it.
    let drawn = [("the light sample", sampled, light), ("the BSDF sample", hit, bsdf)];
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

/// How all findings of this part begin.
pub(super) const BEGINNING: &str = "with densities per solid angle";

/// One finding for all pairs that fail alike: the first of them, and how many there are.
fn describe(pairs: &[Pair], judged: bool) -> Vec<Finding> {
    let mut findings = Vec::new();
    let mut add = |wrong: &dyn Fn(&Outcome) -> bool, words: &dyn Fn(&Pair) -> String| {
        let all: Vec<&Pair> = pairs.iter().filter(|pair| wrong(&pair.outcome)).collect();
        let Some(first) = all.first() else { return };
        let count = all.len();
        let bad = all.iter().filter(|pair| matches!(pair.outcome, Outcome::NoRadiance(..))).count() as u64;
        findings.push(Finding {
            text: format!(
                "{BEGINNING} of {:.0e} (light) and {:.0e} (BSDF): {} ({count} of {} pairs of densities)",
                first.light,
                first.bsdf,
                words(first),
                pairs.len()
            ),
            judged,
            anomalies: [bad, 0],
        });
    };
    add(&|outcome| matches!(outcome, Outcome::NoRadiance(..)), &|pair| {
        let Outcome::NoRadiance(way, value) = pair.outcome else { return String::new() };
        format!("{way} gives {value}; likely cause: {}", cause(pair))
    });
    add(&|outcome| matches!(outcome, Outcome::Sum(_)), &|pair| {
        let Outcome::Sum(sum) = pair.outcome else { return String::new() };
        format!("the two weights sum to {sum:.4} instead of 1; likely cause: {}", cause_of_sum(pair, sum))
    });
    add(&|outcome| matches!(outcome, Outcome::Bright), &|_| {
        "a sample of infinite density brings light, though 1/∞ is 0; likely cause: ∞/∞ turned into 1"
            .to_owned()
    });
    findings
}

/// What makes NaN or infinity of such operands.
fn cause(pair: &Pair) -> &'static str {
    let Pair { light, bsdf, .. } = *pair;
    let (least, greatest) = (light.min(bsdf), light.max(bsdf));
    if greatest == 0.0 {
        "0/0, as in p / (p + q) with both 0"
    } else if greatest.is_infinite() {
        "∞/∞, as in p / (p + q) with p infinite"
    } else if least == 0.0 {
        "0/0 or 1/0, from a density of 0 of the other technique"
    } else if greatest > 1e19 {
        "∞/∞ after the square or the sum of densities has overflowed"
    } else if least < 1e-19 {
        "0/0 after the square of densities has underflowed"
    } else {
        "a quotient or product of densities that over- or underflows"
    }
}

fn cause_of_sum(pair: &Pair, sum: f64) -> &'static str {
    let Pair { light, bsdf, .. } = *pair;
    if sum > 1.5 {
        "an infinite square or sum of densities is patched to a weight of 1 on both sides"
    } else if light.max(bsdf) > 1e19 || light.min(bsdf) < 1e-19 {
        "the square of a density over- or underflows, and NaN is hidden as 0"
    } else {
        "densities are limited to a fixed range, or weighed differently in the two ways"
    }
}
