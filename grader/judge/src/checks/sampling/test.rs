//! The test of one map.
//!
//! The order is that of causes: what is not a density cannot be integrated, and frequencies are compared with a density only
//! if it is right. Each χ² test has a level of [`LEVEL`]; with three of them for each of eleven maps, a correct submission
//! fails with a probability below 4e-6.

use arty::environment::Environment;
use host::protocol::{SampledDirection, SampledDirections};
use statrs::distribution::{ChiSquared, ContinuousCDF};
use verdict::check::SamplingFlaw;

use super::truth::{PARTS, Point, Truth};

/// Level of each χ² test.
const LEVEL: f64 = 1e-7;
/// Expected count of each category of a χ² test, at least.
const MIN_EXPECTED: f64 = 10.0;
/// Share of the samples that rounding may take to the next texel, where the density is another one, or none.
const ROUNDED: f64 = 2e-3;
/// Relative difference of densities that rounding explains.
const SAME: f64 = 1e-3;
/// Relative error of a texel's density, and absolute error of its probability: tables in single precision have as much.
const DENSITY_ERROR: f64 = 5e-3;
const PROBABILITY_ERROR: f64 = 1e-6;
/// Error of the integral.
const INTEGRAL_ERROR: f64 = 2e-3;

/// Measurements of one sampler with one map.
pub(super) struct Measured {
    pub(super) flaw: Option<SamplingFlaw>,
    pub(super) integral: f64,
    pub(super) variance: Option<f64>,
}

/// Tests samples and densities of a map: the densities of `points`, then those of edges.
pub(super) fn test(truth: &Truth, points: &[Point], sampled: &SampledDirections) -> Measured {
    let found: Vec<SampledDirection> = sampled.samples.iter().copied().flatten().collect();
    let (inside, _) = sampled.densities.split_at(points.len());
    let masses: Vec<f64> =
        points.iter().zip(inside).map(|(point, &pdf)| f64::from(pdf) * point.solid_angle).collect();
    let integral = masses.iter().sum();
    let variance = variance(&truth.environment, &found);
    let flaw = flaw(truth, points, sampled, &found, &masses, variance);
    Measured { flaw, integral, variance }
}

fn flaw(
    truth: &Truth,
    points: &[Point],
    sampled: &SampledDirections,
    found: &[SampledDirection],
    masses: &[f64],
    variance: Option<f64>,
) -> Option<SamplingFlaw> {
    let is_unit = |sample: &SampledDirection| (sample.wi.length() - 1.0).abs() < 1e-3;
    let is_density = |pdf: &f32| *pdf >= 0.0;
    let (inside, _) = sampled.densities.split_at(points.len());
    if !found.iter().all(is_unit) {
        return Some(SamplingFlaw::NoDirection);
    }
    // At the poles themselves, the density of a valid sampler may be infinite; elsewhere it is finite.
    if !sampled.densities.iter().all(is_density) || !inside.iter().all(|pdf| pdf.is_finite()) {
        return Some(SamplingFlaw::NoDensity);
    }
    if truth.is_black() {
        let dark = found.is_empty() && inside.iter().all(|&pdf| pdf == 0.0);
        return (!dark).then_some(SamplingFlaw::InTheDark);
    }
    let returned = found.len() as f64 / sampled.samples.len() as f64;
    if returned < 1.0 - ROUNDED {
        return Some(SamplingFlaw::NoSample { returned });
    }
    if !found.iter().all(|sample| sample.pdf > 0.0 && sample.pdf.is_finite() && sample.density >= 0.0) {
        return Some(SamplingFlaw::NoDensity);
    }
    disagreement(found)
        .or_else(|| {
            let integral: f64 = masses.iter().sum();
            ((integral - 1.0).abs() > INTEGRAL_ERROR).then_some(SamplingFlaw::Integral)
        })
        .or_else(|| wrong_density(truth, points, masses))
        .or_else(|| wrong_frequency(truth, points, found, masses))
        .or_else(|| {
            let is_noisy = variance.is_some_and(|variance| variance > 0.5 * truth.variance_of_uniform);
            (is_noisy && truth.variance_of_uniform > 1.0).then_some(SamplingFlaw::Noise)
        })
}

/// Whether `sample` and `pdf` return the same density.
fn disagreement(found: &[SampledDirection]) -> Option<SamplingFlaw> {
    let ratio = |sample: &SampledDirection| f64::from(sample.pdf) / f64::from(sample.density);
    let mut ratios: Vec<f64> =
        found.iter().map(ratio).filter(|ratio| ratio.is_nan() || (ratio - 1.0).abs() > SAME).collect();
    let share = ratios.len() as f64 / found.len() as f64;
    if share <= ROUNDED {
        return None;
    }
    ratios.sort_by(f64::total_cmp);
    Some(SamplingFlaw::Disagree { share, ratio: ratios[ratios.len() / 2].min(f64::MAX) })
}

/// The mass of each texel, and of each of its parts.
fn sums(truth: &Truth, points: &[Point], masses: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let (mut texels, mut parts) =
        (vec![0.0; truth.probabilities.len()], vec![0.0; truth.probabilities.len() * PARTS * PARTS]);
    for (point, mass) in points.iter().zip(masses) {
        texels[point.place.texel] += mass;
        parts[point.place.index()] += mass;
    }
    (texels, parts)
}

fn wrong_density(truth: &Truth, points: &[Point], masses: &[f64]) -> Option<SamplingFlaw> {
    let (texels, _) = sums(truth, points, masses);
    let excess = |texel: usize| {
        let (mass, expected) = (texels[texel], truth.probabilities[texel]);
        ((mass - expected).abs() - PROBABILITY_ERROR) / expected.max(PROBABILITY_ERROR)
    };
    let worst = (0..texels.len()).max_by(|&a, &b| excess(a).total_cmp(&excess(b)))?;
    let ratio = texels[worst] / truth.probabilities[worst];
    (excess(worst) > DENSITY_ERROR).then(|| SamplingFlaw::Density {
        column: (worst % truth.width) as u32,
        row: (worst / truth.width) as u32,
        ratio: ratio.min(f64::MAX),
    })
}

/// Frequencies of texels against the density and against the sheet, and of the parts of texels against the density.
fn wrong_frequency(
    truth: &Truth,
    points: &[Point],
    found: &[SampledDirection],
    masses: &[f64],
) -> Option<SamplingFlaw> {
    let (texels, parts) = sums(truth, points, masses);
    let (mut of_texels, mut of_parts) = (vec![0.0; texels.len()], vec![0.0; parts.len()]);
    for sample in found {
        let place = truth.place_of(sample.wi);
        of_texels[place.texel] += 1.0;
        of_parts[place.index()] += 1.0;
    }
    let count = found.len() as f64;
    let differ =
        |observed: &[f64], probabilities: &[f64]| chi_squared(observed, probabilities, count) < LEVEL;
    if differ(&of_texels, &texels) || differ(&of_texels, &truth.probabilities) {
        let deviation = |texel: usize| {
            let expected = count * truth.probabilities[texel];
            (of_texels[texel] - expected).abs() / expected.max(MIN_EXPECTED).sqrt()
        };
        let worst = (0..texels.len()).max_by(|&a, &b| deviation(a).total_cmp(&deviation(b)))?;
        return Some(SamplingFlaw::Frequency {
            column: (worst % truth.width) as u32,
            row: (worst / truth.width) as u32,
            ratio: (of_texels[worst] / (count * truth.probabilities[worst])).min(f64::MAX),
        });
    }
    (truth.is_detailed() && differ(&of_parts, &parts)).then_some(SamplingFlaw::WithinTexels)
}

/// The p-value of Pearson's χ² test of counts. Neighbouring categories are pooled until enough are expected in each.
fn chi_squared(observed: &[f64], probabilities: &[f64], count: f64) -> f64 {
    let mut pools: Vec<[f64; 2]> = Vec::new();
    let mut pool = [0.0; 2];
    for (&seen, &probability) in observed.iter().zip(probabilities) {
        pool = [pool[0] + seen, pool[1] + count * probability];
        if pool[1] >= MIN_EXPECTED {
            pools.push(std::mem::take(&mut pool));
        }
    }
    if let Some(last) = pools.last_mut() {
        *last = [last[0] + pool[0], last[1] + pool[1]];
    }
    if pools.len() < 2 {
        return 1.0;
    }
    let statistic: f64 = pools.iter().map(|[seen, expected]| (seen - expected).powi(2) / expected).sum();
    ChiSquared::new((pools.len() - 1) as f64).map_or(1.0, |distribution| distribution.sf(statistic))
}

/// Relative variance of the estimate luminance / density.
fn variance(environment: &Environment, found: &[SampledDirection]) -> Option<f64> {
    let estimates: Vec<f64> = found
        .iter()
        .map(|sample| f64::from(environment.radiance(sample.wi).luminance()) / f64::from(sample.pdf))
        .collect();
    let count = estimates.len() as f64;
    let mean = estimates.iter().sum::<f64>() / count;
    let spread = estimates.iter().map(|estimate| (estimate - mean).powi(2)).sum::<f64>() / count;
    Some(spread / mean.powi(2)).filter(|variance| variance.is_finite())
}
