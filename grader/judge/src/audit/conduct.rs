//! Conduct: hidden constants, limits, lights that reflect or face away, rays, random numbers.

use arty::integrator::{Settings, Technique};
use harness::job::JobError;
use host::protocol::ProbeJob;
use verdict::audit::{Fact, Factor, Outcome, PathEnd, Place, SurfaceKind, Term, Why};

use super::chain::Chain;
use super::contributions::seen_by_light_samples;
use super::facts::{About, NOISE, NOTHING, deviation, holds_if};
use super::measure::{Case, Effort, Measured, Prober};
use crate::checks::three_lights;

/// Number of lights with which rays are counted.
const MANY_LIGHTS: usize = 8;

/// Number of paths whose random numbers are compared. Of independent paths that select one of three lights, a third is
/// equal to the next one, with a standard error of 0.02.
const RANDOM_PATHS: usize = 512;

/// Effort for the same paths again.
const REPEATED: Effort = Effort { first: 64, set: 512, most: usize::MAX };

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
        return Ok(vec![about.not_measured(Factor::Scale, 1.0, Why::NothingArrives)]);
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
pub(super) fn facts(prober: &mut Prober<'_>, technique: Technique) -> Result<Vec<Fact>, JobError> {
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
    let unknown = about.not_measured(Factor::Scale, 1.0, Why::NothingArrives);
    let mut facts: Vec<Fact> = if ordinary > 0.0 { worst.into_iter().collect() } else { vec![unknown] };
    facts.push(reflecting_light(prober, technique)?);
    facts.push(after_a_light_that_faces_away(prober, technique)?);
    facts.push(repeatable(prober, technique)?);
    facts.push(extreme_densities(prober, technique)?);
    facts.push(random_numbers(prober, technique)?);
    Ok(facts)
}

/// A light that also reflects another one.
fn reflecting_light(prober: &mut Prober<'_>, technique: Technique) -> Result<Fact, JobError> {
    let mut chain = seen_by_light_samples(2, PathEnd::AreaLight);
    let case = |chain: &Chain| Case::new(chain.clone(), technique).light_samples_only();
    let dark = case(&chain);
    chain.last().emits = 0.5;
    let shining = case(&chain);
    let exact = chain.light_sample();
    // What comes from the reflecting light itself. The other light keeps its power, on which selection may depend.
    chain.blocked = vec![0.5];
    let seen = prober.measure_all(&[dark, shining, case(&chain)])?;
    let about = About { term: Term::LightSample, technique, place: Place::Paths };
    if seen[0].value.is_nan() || seen[0].value <= NOTHING * exact {
        return Ok(about.not_measured(Factor::ReflectedByLight, 1.0, Why::NothingArrives));
    }
    let reflected = seen[1].minus(seen[2]);
    let noise = NOISE * reflected.error.hypot(seen[0].error) / exact;
    Ok(about.ratio(Factor::ReflectedByLight, reflected.value / seen[0].value, noise))
}

/// A path whose first hit point has no light sample, since the light faces away from it.
fn after_a_light_that_faces_away(prober: &mut Prober<'_>, technique: Technique) -> Result<Fact, JobError> {
    let chains = [1.0, -1.0].map(|turn| {
        let mut chain = seen_by_light_samples(3, PathEnd::AreaLight);
        chain.turn = turn;
        chain
    });
    let case = |chain: &Chain| Case::new(chain.clone(), technique).light_samples_only();
    let seen = prober.measure_all(&chains.iter().map(case).collect::<Vec<_>>())?;
    let [facing, away] = [0, 1].map(|index| {
        let exact = chains[index].light_sample();
        (seen[index].value / exact, seen[index].error / exact)
    });
    let about = About { term: Term::Path, technique, place: Place::Paths };
    if facing.0.is_nan() || facing.0 <= NOTHING {
        return Ok(about.not_measured(Factor::AfterMissedLightSample, 1.0, Why::NothingArrives));
    }
    let noise = NOISE * facing.1.hypot(away.1) / facing.0;
    Ok(about.ratio(Factor::AfterMissedLightSample, away.0 / facing.0, noise))
}

/// The same paths again give the same result.
fn repeatable(prober: &mut Prober<'_>, technique: Technique) -> Result<Fact, JobError> {
    let chain = Chain::new(&[SurfaceKind::Diffuse; 3], PathEnd::AreaLight);
    let cases = vec![Case::new(chain, technique); 2];
    let seen = prober.measure(&cases, REPEATED)?;
    let about = About { term: Term::Conduct, technique, place: Place::Paths };
    let bits = |seen: &Option<Measured>| seen.map(|it| it.all.map(f64::to_bits));
    let is_same = bits(&seen[0]) == bits(&seen[1]);
    let outcome = if is_same { Outcome::Holds } else { Outcome::Fails };
    Ok(about.fact(Factor::Repeatable, 1.0, f64::from(u8::from(is_same)), outcome))
}

/// The number of rays of a path does not grow with the number of lights.
pub(super) fn rays(prober: &mut Prober<'_>, technique: Technique) -> Result<Vec<Fact>, JobError> {
    let cases = [1, MANY_LIGHTS].map(|lights| {
        let mut chain = seen_by_light_samples(1, PathEnd::PointLight);
        chain.dark_lights = vec![1.0; lights - 1];
        Case::new(chain, technique)
    });
    let rays = prober.rays(&cases)?;
    let about = About { term: Term::Conduct, technique, place: Place::Lights(MANY_LIGHTS as u32) };
    let ratio = f64::from(rays[1]) / f64::from(rays[0].max(1));
    Ok(vec![about.fact(Factor::Rays, 1.0, ratio, holds_if(ratio < 1.5))])
}

/// Densities at which guards and limits of a submission's own show.
fn extreme_densities(prober: &mut Prober<'_>, technique: Technique) -> Result<Fact, JobError> {
    let about = About { term: Term::Conduct, technique, place: Place::Paths };
    let chains = [1.0, 1e-6, 1e6].map(|density: f32| {
        let mut chain = Chain::new(&[SurfaceKind::Diffuse], PathEnd::AreaLight);
        (chain.last().pdf, chain.last().elsewhere.1) = (density, density);
        // Light sample and hit find the same point, so that with `mis` their weights sum to one.
        let p_light = chain.p_light() as f32 / chain.pdf_area;
        chain.pdf_area = 1.7 * density / p_light;
        chain.pdf_area_on_hit = chain.pdf_area;
        chain
    });
    let case = |chain: &Chain| Case::new(chain.clone(), technique);
    let dark: Vec<Case> = chains.iter().map(|chain| case(chain).light_samples_only()).collect();
    let dark = prober.measure_all(&dark)?;
    let both = prober.measure_all(&chains.iter().map(case).collect::<Vec<_>>())?;
    let relative = |index: usize| {
        let chain = &chains[index];
        let hit = both[index].minus(dark[index]);
        let (sampled, found) = (chain.light_sample(), chain.hit_light());
        (
            dark[index].value / sampled + hit.value / found,
            (dark[index].error / sampled).hypot(hit.error / found),
        )
    };
    let ordinary = relative(0);
    if ordinary.0.is_nan() || ordinary.0 <= NOTHING {
        return Ok(about.not_measured(Factor::ExtremeDensities, 1.0, Why::NothingArrives));
    }
    let each = [1, 2].map(|index| {
        let (ratio, error) = relative(index);
        about.ratio(
            Factor::ExtremeDensities,
            ratio / ordinary.0,
            NOISE * error.hypot(ordinary.1) / ordinary.0,
        )
    });
    let [low, high] = each;
    Ok(if deviation(&low) >= deviation(&high) { low } else { high })
}

/// Different paths have random numbers of their own. Red, green and blue come from one light each.
fn random_numbers(prober: &mut Prober<'_>, technique: Technique) -> Result<Fact, JobError> {
    let about = About { term: Term::Conduct, technique, place: Place::Paths };
    let settings = Settings { technique, max_bounces: 1 };
    let mut paths = |stratified| -> Result<Vec<[f32; 3]>, JobError> {
        let scenes = vec![three_lights()];
        let seed = u64::from(prober.seed);
        let job = ProbeJob { settings, scenes, samples: RANDOM_PATHS as u64, seed, stratified };
        Ok(prober.process.probe(&job)?.into_iter().flatten().map(|path| path.radiance).collect())
    };
    let (own, given) = (paths(false)?, paths(true)?);
    let sees_all = |paths: &[[f32; 3]]| (0..3).all(|channel| paths.iter().any(|path| path[channel] > 0.0));
    if !sees_all(&given) {
        return Ok(about.not_measured(Factor::RandomNumbers, 0.0, Why::NothingArrives));
    }
    // How much more often the next path is equal than a distant one.
    let equal = |distance: usize| {
        let pairs = own.iter().zip(own.iter().cycle().skip(distance));
        pairs.take(own.len()).filter(|(a, b)| a == b).count() as f64 / own.len() as f64
    };
    let excess = if sees_all(&own) { equal(1) - equal(RANDOM_PATHS / 2) } else { 1.0 };
    Ok(about.fact(Factor::RandomNumbers, 0.0, excess, holds_if(excess < 0.3)))
}
