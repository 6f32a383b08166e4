//! Light samples and hits: the exponent of every answer.
//!
//! Light samples are measured where the BSDF's density is a hundred-thousandth of theirs, hits the other way round: there
//! every MIS weight is 1, so that exponents are those of the contribution without a weight.

use arty::integrator::Technique;
use arty::math::Rgb;
use harness::job::JobError;
use verdict::audit::{Fact, Factor, PathEnd, Place, SurfaceKind, Term};

use super::chain::Chain;
use super::facts::About;
use super::measure::{Case, Measured, Prober};

/// Density of the technique that is measured, and of the other one.
const HIGH: f32 = 300.0;
const LOW: f32 = 3e-3;

/// One change of a chain: the factor, its exponent in the result, and the change.
type Change = (Factor, f64, fn(&mut Chain));

/// What is added to hits and light samples of one term.
#[derive(Clone, Copy)]
struct Measurement {
    about: About,
    is_light_sample: bool,
}

/// Facts about the light sample of a light with an area.
pub(super) fn light_sample(
    prober: &mut Prober<'_>,
    technique: Technique,
    hit: u32,
) -> Result<Vec<Fact>, JobError> {
    let mut changes: Vec<Change> = vec![
        (Factor::Bsdf, 1.0, |it| it.last().elsewhere.0 *= 2.0),
        (Factor::OtherBsdf, 0.0, |it| it.last().value = 2.0),
        (Factor::ViewerBsdf, 0.0, |it| it.last().at_viewer.0 *= 2.0),
        (Factor::ShadingCosine, 1.0, |it| it.last().lean = 1.3),
        (Factor::GeometricCosine, 0.0, |it| it.last().geometric_lean = 1.3),
        (Factor::LightCosine, 1.0, |it| it.cos_light = 0.4),
        (Factor::Distance, -2.0, |it| it.distance = 2.0),
        (Factor::Emission, 1.0, |it| it.emitted *= 2.0),
        (Factor::OtherChannel, 0.0, |it| it.emitted.g *= 2.0),
        (Factor::AreaDensity, -1.0, |it| it.pdf_area *= 2.0),
        (Factor::OtherAreaDensity, 0.0, |it| it.pdf_area_on_hit *= 2.0),
        (Factor::Lights, 0.0, |it| it.dark_lights = vec![1.0]),
        (Factor::Density, 0.0, |it| it.last().elsewhere.1 *= 2.0),
        (Factor::OtherDensity, 0.0, |it| it.last().density = 2.0),
        (Factor::ViewerDensity, 0.0, |it| it.last().at_viewer.1 *= 2.0),
    ];
    changes.extend(of_throughput(hit));
    let about = About { term: Term::LightSample, technique, place: Place::Hit(hit) };
    let base = seen_by_light_samples(hit, PathEnd::AreaLight);
    Measurement { about, is_light_sample: true }.all(prober, &base, &changes)
}

/// Facts about the light sample of a light without an area.
pub(super) fn point_light(
    prober: &mut Prober<'_>,
    technique: Technique,
    hit: u32,
) -> Result<Vec<Fact>, JobError> {
    let mut changes: Vec<Change> = vec![
        (Factor::Bsdf, 1.0, |it| it.last().elsewhere.0 *= 2.0),
        (Factor::ShadingCosine, 1.0, |it| it.last().lean = 1.3),
        (Factor::Distance, -2.0, |it| it.distance = 2.0),
        (Factor::Emission, 1.0, |it| it.emitted *= 2.0),
        (Factor::Lights, 0.0, |it| it.dark_lights = vec![1.0]),
        (Factor::Density, 0.0, |it| it.last().elsewhere.1 *= 2.0),
        (Factor::OtherDensity, 0.0, |it| it.last().density = 2.0),
    ];
    changes.extend(of_throughput(hit));
    let about = About { term: Term::PointLight, technique, place: Place::Hit(hit) };
    let mut base = seen_by_light_samples(hit, PathEnd::PointLight);
    // Of order one, so that a weight would show.
    base.last().elsewhere.1 = 0.8;
    base.last().density = 0.8 / LOW;
    base.last().value = 0.8 / LOW;
    base.emitted = Rgb::new(3.0, 2.0, 1.0);
    Measurement { about, is_light_sample: true }.all(prober, &base, &changes)
}

/// Facts about emission on a hit after a bounce that is no delta bounce.
pub(super) fn hit(prober: &mut Prober<'_>, technique: Technique, hit: u32) -> Result<Vec<Fact>, JobError> {
    let mut changes: Vec<Change> = vec![
        (Factor::Emission, 1.0, |it| it.emitted *= 2.0),
        (Factor::Bsdf, 1.0, |it| it.last().value = 2.0),
        (Factor::OtherBsdf, 0.0, |it| it.last().elsewhere.0 *= 2.0),
        (Factor::Density, -1.0, |it| it.last().density = 0.5),
        (Factor::ShadingCosine, 1.0, lean_with_the_same_value),
        (Factor::GeometricCosine, 0.0, |it| it.last().geometric_lean = 1.3),
        (Factor::LightCosine, 0.0, |it| it.cos_light = 0.4),
        (Factor::Distance, 0.0, |it| it.distance = 2.0),
        (Factor::AreaDensity, 0.0, |it| it.pdf_area_on_hit *= 2.0),
        (Factor::OtherAreaDensity, 0.0, |it| it.pdf_area *= 2.0),
        (Factor::Lights, 0.0, |it| it.dark_lights = vec![1.0]),
    ];
    changes.extend(of_throughput(hit));
    let about = About { term: Term::Hit, technique, place: Place::Hit(hit) };
    let mut base = chain(hit, PathEnd::AreaLight);
    (base.last().pdf, base.last().elsewhere) = (HIGH, (Rgb::gray(1e-3), HIGH));
    base.emitted = Rgb::new(1.0, 0.7, 0.4);
    with_p_light(&mut base, LOW);
    Measurement { about, is_light_sample: false }.all(prober, &base, &changes)
}

/// With next event estimation, a hit after a bounce counts only if that is a delta bounce.
pub(super) fn hit_with_nee(prober: &mut Prober<'_>, hit: u32) -> Result<Vec<Fact>, JobError> {
    let about = About { term: Term::Hit, technique: Technique::Nee, place: Place::Hit(hit) };
    let base = chain(hit, PathEnd::AreaLight);
    let mut failed = base.clone();
    failed.blocked = vec![0.5];
    failed.apart = 0.25;
    let cases: Vec<Case> = [base.clone(), failed]
        .into_iter()
        .flat_map(|chain| {
            let case = Case::new(chain, Technique::Nee);
            [case.clone(), case.light_samples_only()]
        })
        .collect();
    let seen = prober.measure_all(&cases)?;
    Ok(vec![
        about.nothing(Factor::Size, base.hit_light(), seen[0].minus(seen[1])),
        about.nothing(Factor::Occluded, base.hit_light(), seen[2].minus(seen[3])),
    ])
}

/// A chain in which light samples have a much higher density than the BSDF.
pub(super) fn seen_by_light_samples(hit: u32, end: PathEnd) -> Chain {
    let mut base = chain(hit, end);
    let last = base.last();
    last.pdf = LOW;
    last.elsewhere = (Rgb::new(1.0, 0.6, 0.3), LOW);
    last.at_viewer.1 = 0.7 * LOW;
    base.emitted = Rgb::new(HIGH, 0.7 * HIGH, 0.4 * HIGH);
    with_p_light(&mut base, HIGH);
    base
}

/// A chain with different light points for light samples and hits.
fn chain(hit: u32, end: PathEnd) -> Chain {
    let mut chain = Chain::new(&vec![SurfaceKind::Diffuse; hit as usize], end);
    chain.apart = 0.25;
    if hit > 1 {
        chain.at(hit as usize - 1).throughput = Rgb::new(1.0, 0.9, 0.8);
    }
    chain
}

fn with_p_light(chain: &mut Chain, p_light: f32) {
    (chain.pdf_area, chain.pdf_area_on_hit) = (1.0, 1.0);
    chain.pdf_area = p_light / chain.p_light() as f32;
    chain.pdf_area_on_hit = p_light / chain.p_light_on_hit() as f32;
}

/// The throughput before the last surface.
fn of_throughput(hit: u32) -> Vec<Change> {
    let changes: [Change; 2] = [
        (Factor::PreviousBsdf, 1.0, |it| before_last(it).value = 2.0),
        (Factor::PreviousDensity, -1.0, |it| before_last(it).density = 0.5),
    ];
    if hit > 1 { changes.to_vec() } else { Vec::new() }
}

fn before_last(chain: &mut Chain) -> &mut super::chain::Surface {
    let count = chain.surfaces.len();
    chain.at(count - 1)
}

/// Changes the cosine of the sampled direction, and not the BSDF's value.
fn lean_with_the_same_value(chain: &mut Chain) {
    let before = chain.hit().cos;
    chain.last().lean = 1.3;
    chain.last().value = (chain.hit().cos / before) as f32;
}

/// The logarithm of the ratio by which a change multiplied a factor.
pub(super) fn log_change(factor: Factor, before: &Chain, after: &Chain, of_light_sample: bool) -> f64 {
    let segment = |chain: &Chain| if of_light_sample { chain.sampled() } else { chain.hit() };
    let (before, after) = (segment(before), segment(after));
    let ratio = match factor {
        Factor::ShadingCosine => after.cos / before.cos,
        Factor::GeometricCosine => after.geometric_cos / before.geometric_cos,
        Factor::LightCosine => after.cos_light / before.cos_light,
        Factor::Distance => after.distance / before.distance,
        _ => 2.0,
    };
    ratio.ln()
}

impl Measurement {
    fn all(self, prober: &mut Prober<'_>, base: &Chain, changes: &[Change]) -> Result<Vec<Fact>, JobError> {
        let mut chains = vec![base.clone()];
        chains.extend(changes.iter().map(|(_, _, change)| {
            let mut changed = base.clone();
            change(&mut changed);
            changed
        }));
        let special = self.special(base);
        chains.extend(special.iter().map(|(_, _, chain)| chain.clone()));
        let seen = self.measure(prober, &chains)?;
        let exact = if self.is_light_sample { base.light_sample() } else { base.hit_light() };
        let mut facts = Vec::new();
        for (index, (factor, expected, _)) in changes.iter().enumerate() {
            let mut by = log_change(*factor, base, &chains[index + 1], self.is_light_sample);
            let halved =
                *factor == Factor::PreviousDensity || (!self.is_light_sample && *factor == Factor::Density);
            if halved {
                by = -by;
            }
            facts.push(self.about.exponent((*factor, *expected), [seen[0], seen[index + 1]], by, exact));
        }
        let colors = base.colors()[usize::from(!self.is_light_sample)];
        let exact_colors = colors.map(|color| exact * color);
        for ((factor, arrives, _), seen) in special.iter().zip(&seen[changes.len() + 1..]) {
            facts.push(match arrives {
                true => self.about.size(*factor, exact_colors, *seen),
                false => self.about.nothing(*factor, exact, *seen),
            });
        }
        facts.push(self.about.size(Factor::Size, exact_colors, seen[0]));
        Ok(facts)
    }

    fn measure(self, prober: &mut Prober<'_>, chains: &[Chain]) -> Result<Vec<Measured>, JobError> {
        let case = |chain: &Chain| Case::new(chain.clone(), self.about.technique);
        let dark: Vec<Case> = chains.iter().map(|chain| case(chain).light_samples_only()).collect();
        let light_samples = prober.measure_all(&dark)?;
        if self.is_light_sample {
            return Ok(light_samples);
        }
        let both = prober.measure_all(&chains.iter().map(case).collect::<Vec<_>>())?;
        Ok(both.into_iter().zip(light_samples).map(|(both, dark)| both.minus(dark)).collect())
    }

    /// Chains in which the same arrives, or nothing.
    fn special(self, base: &Chain) -> Vec<(Factor, bool, Chain)> {
        let changed = |change: &dyn Fn(&mut Chain)| {
            let mut chain = base.clone();
            change(&mut chain);
            chain
        };
        if !self.is_light_sample {
            return Vec::new();
        }
        vec![
            (Factor::WithoutBsdfSample, true, changed(&|it| it.last().samples_nothing = true)),
            (Factor::ObjectBehindLight, true, changed(&|it| it.blocked = vec![1.15])),
            (Factor::Occluded, false, changed(&|it| it.blocked = vec![0.5])),
            (Factor::OccludedAtLight, false, changed(&|it| it.blocked = vec![0.9997])),
            (Factor::OccludedAtReceiver, false, changed(&|it| it.blocked = vec![0.0003])),
            (Factor::BelowHorizon, false, changed(&|it| it.last().faces_away = true)),
            (Factor::DeltaBsdf, false, changed(&|it| it.last().kind = SurfaceKind::Mirror)),
        ]
    }
}
