//! Random decisions and hidden constants: roulette, the choice of a light, scales, repeatability.

use arty::integrator::Technique;
use arty::math::Rgb;
use harness::job::JobError;
use verdict::audit::{Fact, Factor, Outcome, PathEnd, Place, SurfaceKind, Term};

use super::chain::Chain;
use super::contributions::seen_by_light_samples;
use super::facts::{About, NOISE, NOTHING, RATIO, holds_if};
use super::measure::{Case, Effort, Measured, Prober};

/// Lengths of the paths on which roulette is looked for.
const LENGTHS: [usize; 7] = [1, 2, 4, 5, 6, 7, 9];

/// Effort for decisions whose probability must be known well.
const ROULETTE: Effort = Effort { first: 64, set: 512, most: usize::MAX };
const SELECTION: Effort = Effort { first: 64, set: 2048, most: usize::MAX };

/// Numbers of lights, and their relative powers.
const COUNTS: [usize; 5] = [1, 2, 3, 5, 8];
const POWERS: [f32; 8] = [1.0, 3.0, 0.5, 2.0, 1.2, 0.3, 4.0, 1.5];

/// Facts about Russian roulette: the mean of long paths with given throughputs per bounce.
pub(super) fn roulette(prober: &mut Prober<'_>, technique: Technique) -> Result<Vec<Fact>, JobError> {
    let about = About { term: Term::Roulette, technique, place: Place::Paths };
    let mut facts = Vec::new();
    for (factor, throughput) in [
        (Factor::GreyThroughput, Rgb::gray(0.85)),
        (Factor::ColoredThroughput, Rgb::new(0.95, 0.0, 0.5)),
        (Factor::ColoredThroughput, Rgb::new(0.0, 0.95, 0.5)),
        (Factor::ColoredThroughput, Rgb::new(0.0, 0.5, 0.95)),
        (Factor::HighThroughput, Rgb::gray(1.4)),
    ] {
        let chains = LENGTHS.map(|length| {
            let mut chain = Chain::new(&vec![SurfaceKind::Diffuse; length], PathEnd::AreaLight);
            chain.surfaces.iter_mut().for_each(|surface| surface.throughput = throughput);
            // The weights of light sample and hit are 1/2 at most: both have the same density.
            let p_light = chain.p_light() as f32 / chain.pdf_area;
            chain.pdf_area = 0.25 / p_light;
            chain.pdf_area_on_hit = chain.pdf_area;
            chain
        });
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
        // Relative to the shortest path, which roulette rarely ends.
        let excess = |(deviation, error): &(f64, f64)| deviation.abs() - NOISE * error - 2.0 * RATIO;
        let worst = ratios.iter().max_by(|a, b| excess(a).total_cmp(&excess(b)));
        let Some(worst) = worst else { continue };
        let fact = about.fact(factor, 1.0, 1.0 + worst.0, holds_if(excess(worst) <= 0.0));
        keep_worst(&mut facts, fact);
    }
    Ok(facts)
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

/// How far a ratio is off; failed ones more than others.
fn deviation(fact: &Fact) -> f64 {
    let off = fact.measured.map_or(f64::INFINITY, |measured| (measured - 1.0).abs());
    if fact.fails() { off + 1e6 } else { off }
}

/// The result grows with the radiance of the light, whatever else is wrong with it: relative to the result for an
/// ordinary light.
pub(super) fn brightness(prober: &mut Prober<'_>, technique: Technique) -> Result<Vec<Fact>, JobError> {
    let factors = [1.0, 1e-6, 1e-3, 1e3, 1e6];
    let case = |factor: f32| {
        let mut chain = seen_by_light_samples(1, PathEnd::AreaLight);
        chain.emitted *= factor;
        Case::new(chain, technique).light_samples_only()
    };
    let seen = prober.measure_all(&factors.map(case))?;
    let about = About { term: Term::Conduct, technique, place: Place::Hit(1) };
    let ordinary = seen[0];
    if ordinary.value.is_nan() || ordinary.value <= 0.0 {
        return Ok(vec![about.not_measured(Factor::Scale, 1.0, verdict::audit::Why::NothingArrives)]);
    }
    let each = factors.iter().zip(&seen).skip(1).map(|(&factor, seen)| {
        let exact = ordinary.value * f64::from(factor);
        about.ratio(
            Factor::Scale,
            seen.value / exact,
            NOISE * (seen.error / exact).hypot(ordinary.error / ordinary.value),
        )
    });
    Ok(each.max_by(|a, b| deviation(a).total_cmp(&deviation(b))).into_iter().collect())
}

/// Facts about a light that is near or far, or reflects another one, and about the same call twice.
pub(super) fn conduct(prober: &mut Prober<'_>, technique: Technique) -> Result<Vec<Fact>, JobError> {
    let about = About { term: Term::Conduct, technique, place: Place::Paths };
    let chains = [1.0, 1e-2f32, 1e2].map(|scale| {
        let mut chain = seen_by_light_samples(1, PathEnd::AreaLight);
        chain.scale = scale;
        chain.pdf_area /= scale * scale;
        chain.pdf_area_on_hit /= scale * scale;
        chain
    });
    let case = |chain: &Chain| Case::new(chain.clone(), technique).light_samples_only();
    let seen = prober.measure_all(&chains.iter().map(case).collect::<Vec<_>>())?;
    // Relative to a light at an ordinary distance: a constant factor is not this fact's matter.
    let relative = |chain: &Chain, seen: &Measured| seen.value / chain.light_sample();
    let ordinary = relative(&chains[0], &seen[0]);
    let each = chains.iter().zip(&seen).skip(1).map(|(chain, seen)| {
        let noise = NOISE * seen.error / chain.light_sample() / ordinary;
        about.ratio(Factor::Scale, relative(chain, seen) / ordinary, noise)
    });
    let worst = each.max_by(|a, b| deviation(a).total_cmp(&deviation(b)));
    let unknown = about.not_measured(Factor::Scale, 1.0, verdict::audit::Why::NothingArrives);
    let mut facts: Vec<Fact> = if ordinary > 0.0 { worst.into_iter().collect() } else { vec![unknown] };
    facts.push(reflecting_light(prober, technique)?);
    facts.push(repeatable(prober, technique)?);
    Ok(facts)
}

/// A light that also reflects another light.
fn reflecting_light(prober: &mut Prober<'_>, technique: Technique) -> Result<Fact, JobError> {
    let mut chain = seen_by_light_samples(1, PathEnd::AreaLight);
    let dark = Case::new(chain.clone(), technique).light_samples_only();
    chain.last().emits = 0.5;
    let shining = Case::new(chain.clone(), technique).light_samples_only();
    let seen = prober.measure_all(&[dark, shining])?;
    let about = About { term: Term::LightSample, technique, place: Place::Paths };
    let exact = chain.light_sample();
    if seen[0].value.is_nan() || seen[0].value <= NOTHING * exact {
        return Ok(about.not_measured(Factor::ReflectedByLight, 1.0, verdict::audit::Why::NothingArrives));
    }
    let noise = NOISE * seen[1].error.hypot(seen[0].error) / exact;
    Ok(about.ratio(Factor::ReflectedByLight, seen[1].value / seen[0].value, noise))
}

/// The same paths again give the same result.
fn repeatable(prober: &mut Prober<'_>, technique: Technique) -> Result<Fact, JobError> {
    let chain = Chain::new(&[SurfaceKind::Diffuse; 3], PathEnd::AreaLight);
    let cases = vec![Case::new(chain, technique); 2];
    let seen = prober.measure(&cases, ROULETTE)?;
    let about = About { term: Term::Conduct, technique, place: Place::Paths };
    let bits = |seen: &Option<Measured>| seen.map(|it| it.all.map(f64::to_bits));
    let is_same = bits(&seen[0]) == bits(&seen[1]);
    let outcome = if is_same { Outcome::Holds } else { Outcome::Fails };
    Ok(about.fact(Factor::Repeatable, 1.0, f64::from(u8::from(is_same)), outcome))
}
