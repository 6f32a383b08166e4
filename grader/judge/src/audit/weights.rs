//! MIS weights: what they depend on, and whether those of one path sum to one.
//!
//! A light sample contributes w_L K / p_L, a hit w_B K / p_B, and both contributions are measured apart. The odds
//! w_L / (1 − w_L) and (1 − w_B) / w_B of the balance heuristic are p_L / p_B, those of the power heuristic its square.
//! Exponents of the odds are therefore divided by that of the heuristic: what remains is the form of the densities.

use arty::integrator::Technique;
use arty::math::Rgb;
use harness::job::JobError;
use verdict::audit::{Fact, Factor, Outcome, PathEnd, Place, SurfaceKind, Term, Why};

use super::chain::Chain;
use super::contributions::log_change;
use super::facts::{About, NOISE, RATIO, holds_if};
use super::measure::{Case, Effort, Measured, Prober};

/// One change of a chain: the factor, and its exponent in the odds of the light sample's and of the hit's weight; `None`
/// if it is not looked at there.
type Change = (Factor, [Option<f64>; 2], fn(&mut Chain));

/// Both weights of a chain's last surface, with standard errors.
#[derive(Clone, Copy, Debug)]
struct Weights {
    light: f64,
    hit: f64,
    errors: [f64; 2],
}

/// Densities of hits, and the densities of light samples relative to them, for which the weights must sum to one.
const SUMS: [(f32, f32); 5] = [(2.0, 0.25), (2.0, 1.7), (2.0, 6.0), (0.05, 1.7), (60.0, 1.7)];

/// Enough paths that roulette rarely ends all of them before a late hit.
const LATE: Effort = Effort { first: 4096, set: 512, most: usize::MAX };

/// Facts about the weights at a hit point.
pub(super) fn facts(prober: &mut Prober<'_>, hit: u32) -> Result<Vec<Fact>, JobError> {
    let base = chain(hit, 0.25);
    let changes = changes(hit);
    let mut chains = vec![base.clone()];
    chains.extend(changes.iter().map(|(_, _, change)| {
        let mut changed = base.clone();
        change(&mut changed);
        changed
    }));
    let rise = [0.125f32, 8.0].map(|factor| scaled(&base, factor));
    chains.extend(rise);
    chains.extend(of_sums(hit));
    // More lights, of which the others are brighter or dimmer.
    let unequal: [&[f32]; 3] = [&[3.0], &[0.2], &[1.0, 2.0, 0.5]];
    chains.extend(unequal.map(|others| {
        let mut chain = with_ratio(chain(hit, 0.0), 1.7);
        chain.dark_lights = others.to_vec();
        chain
    }));
    let weights = measure(prober, &chains, Effort::USUAL)?;

    let (first, rest) = weights.split_at(changes.len() + 1);
    let (sums, unequal) = rest[2..].split_at(SUMS.len());
    let sum = worst_sum(hit, Factor::Sum, sums);
    let unequal = worst_sum(hit, Factor::SumWithUnequalLights, unequal);
    let sums_hold = !unequal.fails();
    let mut facts = Vec::new();
    for (side, term) in [Term::LightWeight, Term::HitWeight].into_iter().enumerate() {
        let about = About { term, technique: Technique::Mis, place: Place::Hit(hit) };
        facts.extend(dependence(about, side, first, &chains, &changes, sums_hold));
        facts.push(rises(about, side, &rest[..2]));
    }
    facts.extend([sum, unequal]);
    Ok(facts)
}

/// The sum of the weights at a hit point late on a path. No fact if roulette ends all paths before.
pub(super) fn sum(prober: &mut Prober<'_>, hit: u32) -> Result<Vec<Fact>, JobError> {
    let weights = measure(prober, &of_sums(hit), LATE)?;
    let arrives = weights.iter().all(|it| it.light != 0.0 || it.hit != 0.0);
    Ok(if arrives { vec![worst_sum(hit, Factor::Sum, &weights)] } else { Vec::new() })
}

/// Chains whose light sample and hit find the same point, so that their weights sum to one.
fn of_sums(hit: u32) -> [Chain; SUMS.len()] {
    SUMS.map(|(pdf, ratio)| {
        let mut chain = chain(hit, 0.0);
        chain.last().pdf = pdf;
        with_ratio(chain, ratio)
    })
}

fn chain(hit: u32, apart: f32) -> Chain {
    let mut chain = Chain::new(&vec![SurfaceKind::Diffuse; hit as usize], PathEnd::AreaLight);
    chain.apart = apart;
    let last = chain.last();
    last.pdf = 2.0;
    last.elsewhere = (Rgb::gray(1.0), 1.6);
    last.at_viewer = (Rgb::gray(0.7), 5.0);
    if hit > 1 {
        chain.at(hit as usize - 1).pdf = 0.6;
    }
    with_ratio(chain, 1.5)
}

/// The chain with the density of the light sample this many times that of the hit.
fn with_ratio(mut chain: Chain, ratio: f32) -> Chain {
    let p_light = chain.last().pdf * ratio;
    (chain.pdf_area, chain.pdf_area_on_hit) = (1.0, 1.0);
    chain.pdf_area = p_light / chain.p_light() as f32;
    chain.pdf_area_on_hit = p_light / chain.p_light_on_hit() as f32;
    chain
}

fn scaled(base: &Chain, factor: f32) -> Chain {
    let mut chain = base.clone();
    chain.pdf_area *= factor;
    chain.pdf_area_on_hit *= factor;
    chain
}

fn changes(hit: u32) -> Vec<Change> {
    let (none, zero) = (None, Some(0.0));
    let mut changes: Vec<Change> = vec![
        (Factor::Density, [Some(-1.0), none], |it| it.last().elsewhere.1 *= 2.0),
        (Factor::Density, [none, Some(-1.0)], |it| (it.last().density, it.last().value) = (2.0, 2.0)),
        (Factor::OtherDensity, [none, zero], |it| it.last().elsewhere.1 *= 2.0),
        (Factor::OtherDensity, [zero, none], |it| (it.last().density, it.last().value) = (2.0, 2.0)),
        (Factor::ViewerDensity, [zero, zero], |it| it.last().at_viewer.1 *= 2.0),
        (Factor::AreaDensity, [Some(1.0), none], |it| it.pdf_area *= 2.0),
        (Factor::AreaDensity, [none, Some(1.0)], |it| it.pdf_area_on_hit *= 2.0),
        (Factor::OtherAreaDensity, [none, zero], |it| it.pdf_area *= 2.0),
        (Factor::OtherAreaDensity, [zero, none], |it| it.pdf_area_on_hit *= 2.0),
        (Factor::LightCosine, [Some(-1.0); 2], |it| it.cos_light = 0.5),
        (Factor::Distance, [Some(2.0); 2], |it| it.distance = 1.5),
        (Factor::Lights, [Some(-1.0); 2], |it| it.dark_lights = vec![1.0]),
        (Factor::ShadingCosine, [zero; 2], |it| it.last().lean = 1.3),
        (Factor::Bsdf, [zero, none], |it| it.last().elsewhere.0 *= 2.0),
        (Factor::Bsdf, [none, zero], |it| it.last().value = 2.0),
        (Factor::Emission, [zero; 2], |it| it.emitted *= 2.0),
    ];
    if hit > 1 {
        changes.push((Factor::PreviousDensity, [zero; 2], |it| {
            let count = it.surfaces.len();
            (it.at(count - 1).density, it.at(count - 1).value) = (2.0, 2.0);
        }));
    }
    changes
}

fn measure(prober: &mut Prober<'_>, chains: &[Chain], effort: Effort) -> Result<Vec<Weights>, JobError> {
    let case = |chain: &Chain| Case::new(chain.clone(), Technique::Mis);
    let dark: Vec<Case> = chains.iter().map(|chain| case(chain).light_samples_only()).collect();
    let mut all = |cases: &[Case]| -> Result<Vec<Measured>, JobError> {
        Ok(prober.measure(cases, effort)?.into_iter().flatten().collect())
    };
    let dark = all(&dark)?;
    let both = all(&chains.iter().map(case).collect::<Vec<_>>())?;
    let weights = chains.iter().zip(both.into_iter().zip(dark)).map(|(chain, (both, dark))| {
        let hit: Measured = both.minus(dark);
        let (sampled, found) = (chain.light_sample(), chain.hit_light());
        Weights {
            light: dark.value / sampled,
            hit: hit.value / found,
            errors: [dark.error / sampled, hit.error / found],
        }
    });
    Ok(weights.collect())
}

/// Exponents in the odds of one of the two weights.
fn dependence(
    about: About,
    side: usize,
    weights: &[Weights],
    chains: &[Chain],
    changes: &[Change],
    sums_hold: bool,
) -> Vec<Fact> {
    let odds = |it: &Weights| {
        let weight = if side == 0 { it.light } else { 1.0 - it.hit };
        (0.02..0.98).contains(&weight).then(|| (weight / (1.0 - weight)).ln())
    };
    let noise = |it: &Weights| it.errors[side] / 0.02f64.max(it.light.min(it.hit).abs());
    let exponents: Vec<Option<f64>> = changes
        .iter()
        .enumerate()
        .map(|(index, (factor, ..))| {
            let by = log_change(*factor, &chains[0], &chains[index + 1], side == 0);
            Some((odds(&weights[index + 1])? - odds(&weights[0])?) / by)
        })
        .collect();
    let own = |factor: Factor| {
        let mut all = changes.iter().zip(&exponents);
        all.find(|((other, expected, _), _)| *other == factor && expected[side].is_some())
            .and_then(|(_, exponent)| *exponent)
    };
    // The exponent of the heuristic: 1 for balance, 2 for power.
    let heuristic = own(Factor::Density).map(|exponent| -exponent).filter(|it| it.abs() > 0.1);
    let heuristic = heuristic.or_else(|| own(Factor::AreaDensity)).filter(|it| it.abs() > 0.1);
    let mut facts = Vec::new();
    for (index, (factor, expected, _)) in changes.iter().enumerate() {
        let Some(expected) = expected[side] else { continue };
        let exponent = exponents[index].zip(heuristic).map(|(exponent, heuristic)| exponent / heuristic);
        facts.push(match exponent {
            None => about.not_measured(*factor, expected, Why::NoSlope),
            Some(exponent) => {
                let noise = NOISE * (noise(&weights[0]) + noise(&weights[index + 1]));
                let mut fact = about.power(*factor, expected, exponent, noise);
                // A choice of lights that depends on the point has another exponent, and weights that sum to one.
                if *factor == Factor::Lights && sums_hold && exponent < -0.1 && fact.fails() {
                    fact.outcome = Outcome::Remark;
                }
                fact
            }
        });
    }
    let heuristic = match heuristic {
        Some(power) if (power - 1.0).abs() < 0.05 => about.fact(Factor::Size, 1.0, power, Outcome::Holds),
        Some(power) => about.fact(Factor::Size, 1.0, power, Outcome::Remark),
        None => about.not_measured(Factor::Size, 1.0, Why::NoSlope),
    };
    facts.push(heuristic);
    facts
}

/// Increase of a weight while the density of its technique becomes 64 times as high relative to the other.
fn rises(about: About, side: usize, ends: &[Weights]) -> Fact {
    let [low, high] = [ends[0], ends[1]].map(|it| if side == 0 { it.light } else { 1.0 - it.hit });
    let noise = NOISE * ends[0].errors[side].hypot(ends[1].errors[side]);
    // With the balance heuristic: from 0.19 / 1.19 to 12 / 13.
    about.fact(Factor::Rise, 0.76, high - low, holds_if(high - low > 0.1 + noise))
}

fn worst_sum(hit: u32, factor: Factor, weights: &[Weights]) -> Fact {
    let about = About { term: Term::Weights, technique: Technique::Mis, place: Place::Hit(hit) };
    let excess = |it: &Weights| {
        let noise = NOISE * it.errors[0].hypot(it.errors[1]);
        ((it.light + it.hit - 1.0).abs() - noise - RATIO, it.light + it.hit)
    };
    let all = weights.iter().map(excess);
    let (excess, sum) = all.max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((f64::NAN, f64::NAN));
    about.fact(factor, 1.0, sum, holds_if(excess <= 0.0))
}
