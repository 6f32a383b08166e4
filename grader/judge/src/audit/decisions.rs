//! Random decisions: roulette and the choice of a light.

use arty::integrator::Technique;
use arty::math::Rgb;
use harness::job::JobError;
use verdict::audit::{Fact, Factor, Outcome, PathEnd, Place, SurfaceKind, Term};

use super::chain::Chain;
use super::facts::{About, NOISE, RATIO, deviation, holds_if};
use super::measure::{Case, Effort, Measured, Prober};

/// Lengths of the paths on which roulette is looked for.
const LENGTHS: [usize; 7] = [1, 2, 4, 5, 6, 7, 9];

/// Effort for decisions whose probability must be known well.
const ROULETTE: Effort = Effort { first: 64, set: 512, most: usize::MAX };
const VANISHING: Effort = Effort { first: 1 << 14, set: 512, most: usize::MAX };
const SELECTION: Effort = Effort { first: 64, set: 2048, most: usize::MAX };

/// Throughput of a bounce without color.
const GREY: Rgb = Rgb::gray(0.85);

/// Numbers of lights, and their relative powers.
const COUNTS: [usize; 5] = [1, 2, 3, 5, 8];
const POWERS: [f32; 8] = [1.0, 3.0, 0.5, 2.0, 1.2, 0.3, 4.0, 1.5];

/// Facts about Russian roulette: the mean of long paths with given throughputs per bounce.
pub(super) fn roulette(prober: &mut Prober<'_>, technique: Technique) -> Result<Vec<Fact>, JobError> {
    let about = About { term: Term::Roulette, technique, place: Place::Paths };
    let mut facts = Vec::new();
    for (factor, throughput) in [
        (Factor::GreyThroughput, GREY),
        (Factor::ColoredThroughput, Rgb::new(0.95, 0.0, 0.5)),
        (Factor::ColoredThroughput, Rgb::new(0.0, 0.95, 0.5)),
        (Factor::ColoredThroughput, Rgb::new(0.0, 0.5, 0.95)),
        (Factor::HighThroughput, Rgb::gray(1.4)),
    ] {
        let chains = LENGTHS.map(|length| chain(throughput, length));
        let cases: Vec<Case> = chains.iter().map(|chain| Case::new(chain.clone(), technique)).collect();
        let seen = prober.measure(&cases, ROULETTE)?;
        let channel = if throughput.r > 0.0 {
            0
        } else if throughput.g > throughput.b {
            1
        } else {
            2
        };
        let ratio = |(chain, seen): (&Chain, &Option<Measured>)| {
            let exact = throughput.to_array()[channel].powi(chain.surfaces.len() as i32);
            let seen = (*seen)?;
            // Density and weights are equal for both techniques, so that each path returns its exact radiance.
            let error = seen.error.max(seen.channel_error(channel)) / f64::from(exact);
            Some((seen.all[channel] / f64::from(exact) - 1.0, error))
        };
        let ratios: Vec<(f64, f64)> = chains.iter().zip(&seen).filter_map(ratio).collect();
        // What is wrong without a random decision is no matter of roulette.
        let certain =
            ratios.first().filter(|(_, error)| *error == 0.0).map_or(1.0, |(deviation, _)| 1.0 + deviation);
        let relative =
            |(deviation, error): (f64, f64)| ((1.0 + deviation) / certain - 1.0, error / certain.abs());
        let ratios: Vec<(f64, f64)> =
            ratios.into_iter().filter(|(_, error)| certain != 0.0 && *error > 0.0).map(relative).collect();
        let excess = |(deviation, error): &(f64, f64)| deviation.abs() - NOISE * error - 2.0 * RATIO;
        let vanishes = |seen: &Option<Measured>| seen.is_some_and(|it| it.all[channel] == 0.0);
        let vanished = LENGTHS.iter().zip(&seen).find(|(_, seen)| certain != 0.0 && vanishes(seen));
        if let Some((&length, _)) = vanished
            && ends_by_color(prober, technique, throughput, length)?
        {
            keep_worst(&mut facts, about.fact(factor, 1.0, 0.0, Outcome::Fails));
            continue;
        }
        let worst = ratios.iter().max_by(|a, b| excess(a).total_cmp(&excess(b)));
        let Some(worst) = worst else { continue };
        let fact = about.fact(factor, 1.0, 1.0 + worst.0, holds_if(excess(worst) <= 0.0));
        keep_worst(&mut facts, fact);
    }
    Ok(facts)
}

/// A path whose surfaces all have this throughput. Light sample and hit have the same density.
fn chain(throughput: Rgb, length: usize) -> Chain {
    let mut chain = Chain::new(&vec![SurfaceKind::Diffuse; length], PathEnd::AreaLight);
    chain.surfaces.iter_mut().for_each(|surface| surface.throughput = throughput);
    let p_light = chain.p_light() as f32 / chain.pdf_area;
    chain.pdf_area = 0.25 / p_light;
    chain.pdf_area_on_hit = chain.pdf_area;
    chain
}

/// True if all paths of a length end early with this throughput, but not with a grey one.
fn ends_by_color(
    prober: &mut Prober<'_>,
    technique: Technique,
    throughput: Rgb,
    length: usize,
) -> Result<bool, JobError> {
    let cases = [throughput, GREY].map(|throughput| Case::new(chain(throughput, length), technique));
    let seen = prober.measure(&cases, VANISHING)?;
    let is_black = |seen: &Option<Measured>| seen.is_some_and(|it| it.all.iter().all(|&value| value == 0.0));
    Ok(is_black(&seen[0]) && !is_black(&seen[1]))
}

/// Keeps one fact per factor: a failed one if there is one.
fn keep_worst(facts: &mut Vec<Fact>, fact: Fact) {
    match facts.iter_mut().find(|other| other.factor == fact.factor) {
        Some(other) if fact.fails() && !other.fails() => *other = fact,
        Some(_) => {}
        None => facts.push(fact),
    }
}

/// Facts about the choice of a light: what each of several unequal lights contributes.
pub(super) fn selection(prober: &mut Prober<'_>, technique: Technique) -> Result<Vec<Fact>, JobError> {
    let mut facts = Vec::new();
    for count in COUNTS {
        let chains: Vec<Chain> = (0..count)
            .map(|index| {
                let mut chain = Chain::new(&[SurfaceKind::Diffuse], PathEnd::PointLight);
                chain.apart = 0.25;
                chain.emitted = Rgb::gray(POWERS[index]);
                // The lights before `index` come one place later: the two are exchanged.
                let mut others: Vec<f32> =
                    POWERS[..count].iter().map(|power| power / POWERS[index]).collect();
                others.swap(0, index);
                chain.dark_lights = others[1..].to_vec();
                chain.index = index;
                chain
            })
            .collect();
        let cases: Vec<Case> = chains.iter().map(|chain| Case::new(chain.clone(), technique)).collect();
        let seen = prober.measure(&cases, SELECTION)?;
        let about = About { term: Term::Selection, technique, place: Place::Lights(count as u32) };
        let each = chains.iter().zip(seen).filter_map(|(chain, seen)| {
            let (exact, seen) = (chain.light_sample(), seen?);
            Some(about.ratio(Factor::Size, seen.value / exact, NOISE * seen.error / exact))
        });
        let worst = each.max_by(|a, b| deviation(a).total_cmp(&deviation(b)));
        facts.extend(worst);
    }
    Ok(facts)
}
