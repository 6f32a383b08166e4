//! Path words: which sequences of surfaces contribute, with which technique and how many bounces.

use arty::integrator::Technique;
use harness::job::JobError;
use verdict::audit::{Fact, Factor, PathEnd, PathWord, Place, SurfaceKind, Term};

use super::chain::{Chain, Surface};
use super::facts::{About, NOISE, NOTHING, RATIO, holds_if};
use super::measure::{Case, Effort, Measured, Prober};

/// Maximum number of surfaces.
const SURFACES: u32 = 4;

/// Number of mirrors of the long path, more than a limit of a submission's own is likely to allow.
const MIRRORS: u32 = 12;

/// Enough paths that roulette rarely ends all of them.
const LONG: Effort = Effort { first: 4096, set: 512, most: usize::MAX };

/// Number of paths that must survive roulette for a fact about the long path.
const SURVIVORS: f64 = 40.0;

/// Number of bounces of the longest paths that are allowed.
const MAX_BOUNCES: u32 = 6;

const KINDS: [SurfaceKind; 5] =
    [SurfaceKind::Diffuse, SurfaceKind::Glossy, SurfaceKind::Mirror, SurfaceKind::Glass, SurfaceKind::Coated];

/// Enough paths that roulette cannot end all of them, and sets of paths for as many words as time allows.
const EFFORT: Effort = Effort { first: 16, set: 128, most: 120 };

/// The classes of paths, in the order in which failed ones should be read.
const CLASSES: [Factor; 8] = [
    Factor::SeenByCamera,
    Factor::WithoutLight,
    Factor::AtLimit,
    Factor::BeyondLimit,
    Factor::AfterDeltaBounces,
    Factor::AfterLaterDeltaBounce,
    Factor::AfterBounceBehindDelta,
    Factor::AfterBounces,
];

/// A word with a maximum number of bounces.
struct Word {
    chain: Chain,
    word: PathWord,
}

/// Facts about the paths of one technique: one per class of paths and kind of end.
pub(super) fn facts(prober: &mut Prober<'_>, technique: Technique) -> Result<Vec<Fact>, JobError> {
    let words = words(technique);
    let case = |it: &Word, emission_on_hit: bool| Case {
        max_bounces: it.word.max_bounces,
        emission_on_hit,
        ..Case::new(it.chain.clone(), technique)
    };
    let both: Vec<Case> = words.iter().map(|it| case(it, true)).collect();
    let both = prober.measure(&both, EFFORT)?;
    // Only weights need the two contributions apart.
    let dark = if technique == Technique::Mis {
        let dark: Vec<Case> = words.iter().map(|it| case(it, false)).collect();
        prober.measure(&dark, EFFORT)?
    } else {
        vec![None; words.len()]
    };
    let mut facts = Vec::new();
    for (term, end) in [(Term::Path, PathEnd::AreaLight), (Term::PointLight, PathEnd::PointLight)] {
        for class in CLASSES {
            let about = About { term, technique, place: Place::Paths };
            let members = words.iter().zip(both.iter().zip(&dark));
            let members = members.filter(|(it, _)| class_of(&it.word) == class && belongs(&it.word, end));
            let judged: Vec<(&Word, f64, bool, f64)> = members
                .filter_map(|(it, (both, dark))| {
                    let (ratio, holds) = judge(it, technique, (*both)?, *dark)?;
                    Some((it, ratio, holds, expected(it, technique)))
                })
                .collect();
            let wrong = judged.iter().find(|(_, _, holds, _)| !holds);
            let Some(&(shown, ratio, _, expected)) = wrong.or(judged.first()) else {
                continue;
            };
            let mut fact = about.fact(class, expected, ratio, holds_if(wrong.is_none()));
            fact.example = wrong.map(|_| shown.word.clone());
            facts.push(fact);
        }
    }
    Ok(facts)
}

/// A path over many mirrors, which only `max_bounces` and roulette may end. No fact if roulette ends nearly all paths
/// before, or if a path half as long is wrong, too.
pub(super) fn long_path(prober: &mut Prober<'_>, technique: Technique) -> Result<Vec<Fact>, JobError> {
    let case = |mirrors: u32| {
        let surfaces = vec![SurfaceKind::Mirror; mirrors as usize];
        let chain = Chain::new(&surfaces, PathEnd::AreaLight);
        (Case { max_bounces: mirrors, ..Case::new(chain, technique) }, surfaces)
    };
    let ((half, _), (whole, surfaces)) = (case(MIRRORS / 2), case(MIRRORS));
    let exact = [half.chain.hit_light(), whole.chain.hit_light()];
    let seen: Vec<Measured> = prober.measure(&[half, whole], LONG)?.into_iter().flatten().collect();
    let [half, whole] =
        [0, 1].map(|index| (seen[index].value / exact[index], seen[index].error / exact[index]));
    // The relative variance of a result that roulette ends with probability 1 − q is 1 / q − 1.
    let survival = 1.0 / (1.0 + f64::from(LONG.first) * (half.1 / half.0).powi(2));
    let is_right = (half.0 - 1.0).abs() <= RATIO + NOISE * half.1;
    // NaN compares as false.
    let is_telling = is_right && f64::from(LONG.first) * survival * survival >= SURVIVORS;
    let about = About { term: Term::Path, technique, place: Place::Paths };
    let mut fact = about.ratio(Factor::LongPath, whole.0, NOISE * whole.1);
    let example = PathWord { surfaces, end: PathEnd::AreaLight, max_bounces: MIRRORS };
    fact.example = fact.fails().then_some(example);
    Ok(if is_telling { vec![fact] } else { Vec::new() })
}

/// Paths that end nowhere are judged with those that end at an area light.
fn belongs(word: &PathWord, end: PathEnd) -> bool {
    word.end == end || (word.end == PathEnd::Nothing && end == PathEnd::AreaLight)
}

/// The words of a technique, short ones first.
fn words(technique: Technique) -> Vec<Word> {
    let mut all = Vec::new();
    let mut last = vec![Vec::new()];
    for count in 0..=SURFACES {
        if count > 0 {
            let longer = |word: &Vec<SurfaceKind>| {
                let word = word.clone();
                KINDS.into_iter().map(move |kind| [&word[..], &[kind]].concat())
            };
            // In long words, a glossy surface acts as a diffuse one, and glass as a mirror.
            let is_new = |word: &Vec<SurfaceKind>| {
                count < 3
                    || !word[..2].iter().any(|kind| matches!(kind, SurfaceKind::Glossy | SurfaceKind::Coated))
            };
            last = last.iter().flat_map(longer).filter(is_new).collect();
        }
        for surfaces in &last {
            for end in [PathEnd::AreaLight, PathEnd::PointLight, PathEnd::Nothing] {
                if end == PathEnd::PointLight && (count == 0 || technique == Technique::Bsdf) {
                    continue;
                }
                let limits: Vec<u32> = match (end, count) {
                    (PathEnd::Nothing, _) => vec![MAX_BOUNCES],
                    (_, 0..=2) => (0..=MAX_BOUNCES).collect(),
                    _ => vec![count - 1, count, MAX_BOUNCES],
                };
                for max_bounces in limits {
                    let word = PathWord { surfaces: surfaces.clone(), end, max_bounces };
                    all.push(Word { chain: chain(&word), word });
                }
            }
        }
    }
    all
}

fn chain(word: &PathWord) -> Chain {
    let mut chain = Chain::new(&word.surfaces, word.end);
    // Light samples have a density other than that of hits, so that every weight shows.
    if let Some(pdf) = word.surfaces.last().map(|&kind| Surface::new(kind).pdf) {
        chain.pdf_area = 1.7 * pdf / (chain.p_light() as f32 / chain.pdf_area);
        chain.pdf_area_on_hit = chain.pdf_area;
    }
    chain
}

fn class_of(word: &PathWord) -> Factor {
    let Some((last, before)) = word.surfaces.split_last() else { return Factor::SeenByCamera };
    let count = word.surfaces.len() as u32;
    let delta_before = before.iter().any(|kind| kind.samples_delta());
    let all_delta = before.iter().all(|kind| kind.samples_delta());
    // Light samples see past the coat of the last surface.
    let is_delta = last.samples_delta() && (word.end != PathEnd::PointLight || last.is_delta());
    match () {
        () if word.end == PathEnd::Nothing => Factor::WithoutLight,
        () if word.max_bounces < count => Factor::BeyondLimit,
        () if word.max_bounces == count => Factor::AtLimit,
        () if is_delta && all_delta => Factor::AfterDeltaBounces,
        () if is_delta => Factor::AfterLaterDeltaBounce,
        () if delta_before => Factor::AfterBounceBehindDelta,
        () => Factor::AfterBounces,
    }
}

/// What a correct estimator returns, relative to the exact contribution of the path.
fn expected(word: &Word, technique: Technique) -> f64 {
    let [sampled, hit] = contributions(word, technique);
    f64::from(u8::from(sampled + hit > 0.0))
}

/// The exact contributions of light sample and hit, each without a weight; 0 for what the technique does not use.
fn contributions(word: &Word, technique: Technique) -> [f64; 2] {
    let PathWord { surfaces, max_bounces, .. } = &word.word;
    if (*max_bounces as usize) < surfaces.len() {
        return [0.0; 2];
    }
    let sampled = if technique == Technique::Bsdf { 0.0 } else { word.chain.light_sample() };
    let seen_by_hits = technique != Technique::Nee || surfaces.last().is_none_or(|last| last.samples_delta());
    [sampled, if seen_by_hits { word.chain.hit_light() } else { 0.0 }]
}

/// The result relative to the exact one, and whether it is right. `None` if it was not measured.
fn judge(word: &Word, technique: Technique, both: Measured, dark: Option<Measured>) -> Option<(f64, bool)> {
    let [sampled, hit] = contributions(word, technique);
    let exact = sampled + hit;
    if exact == 0.0 {
        let worst = both
            .all
            .into_iter()
            .fold(0.0, |worst: f64, value| if value.abs() > worst { value } else { worst });
        let is_finite = both.all.iter().all(|value| value.is_finite());
        return Some((worst, is_finite && worst.abs() <= NOTHING));
    }
    let coated = word.word.surfaces.last().is_some_and(|last| last.samples_delta());
    let (ratio, error) = if technique == Technique::Mis && sampled > 0.0 && hit > 0.0 && !coated {
        // The two weights of one path.
        let dark = dark?;
        let found = both.minus(dark);
        (dark.value / sampled + found.value / hit, (dark.error / sampled).hypot(found.error / hit))
    } else if technique == Technique::Mis && coated && sampled > 0.0 && hit > 0.0 {
        // The light sample may have any weight that knows the BSDF's density; the hit has none.
        let found = both.minus(dark?);
        (found.value / hit, found.error / hit)
    } else {
        (both.value / exact, both.error / exact)
    };
    Some((ratio, (ratio - 1.0).abs() <= RATIO + NOISE * error))
}
