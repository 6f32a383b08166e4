//! Facts of the audit.

use verdict::audit::{Fact, Factor, Outcome, PathEnd, PathWord, Place, SurfaceKind, Term, Unit};

use super::number::{count, significant, trimmed};

/// What a fact that fails, or is a remark, says about the submission, in one sentence.
pub fn fact(fact: &Fact) -> String {
    let about = format!("{} (`{}`)", place(fact), fact.technique);
    let term = term(fact.term);
    let seen = value(fact.measured);
    match (fact.term, fact.factor) {
        (Term::LightWeight | Term::HitWeight, Factor::Rise) => format!(
            "{term} does not increase with the density of its own technique{about}: it must weigh the two densities \
             against each other"
        ),
        (Term::LightWeight | Term::HitWeight, Factor::Size) => {
            format!(
                "{term} compares the densities to the power {seen}{about}: the balance heuristic has the power 1"
            )
        }
        (Term::Weights, Factor::Sum) => {
            format!("the two MIS weights of one path sum to {seen}{about}, not to 1")
        }
        (Term::Weights, _) => {
            format!(
                "with several unequal lights, the two MIS weights of one path sum to {seen}{about}, not to 1"
            )
        }
        (Term::Path | Term::PointLight, _) if matches!(fact.place, Place::Paths) => path(fact),
        (Term::Roulette, factor) => format!(
            "where the throughput {}, Russian roulette changes the mean: it is {seen} times what it should be (`{}`)",
            throughput(factor),
            fact.technique
        ),
        (Term::Selection, _) => format!(
            "one of {about_lights} contributes {seen} times what it should (`{}`): is the probability with which it is \
             sampled the one that is divided by?",
            fact.technique,
            about_lights = lights(fact.place)
        ),
        (_, Factor::Repeatable) => {
            format!(
                "the same call with the same random numbers gives another result the second time (`{}`)",
                fact.technique
            )
        }
        (_, Factor::Rays) => format!(
            "with {}, a path traces {seen} times as many rays as with one (`{}`): the sheet asks for a single shadow ray at \
             each hit point",
            lights(fact.place),
            fact.technique
        ),
        (_, Factor::ExtremeDensities) => format!(
            "where densities are 1e-6 or 1e6, the result is {seen} times what it should be (`{}`); look for limits and \
             constants that are added to densities",
            fact.technique
        ),
        (_, Factor::RandomNumbers) => format!(
            "paths share their random numbers (`{}`): every number must come from the sampler that `radiance` is given",
            fact.technique
        ),
        (_, Factor::Scale) => format!(
            "very dim, bright, near or far light is not proportional: {term} is {seen} times what it should be{about}; \
             look for limits and constants"
        ),
        (_, factor) if factor.unit() == Unit::Exponent => exponent(fact, &about),
        (Term::Hit, Factor::Size) if fact.expected == 0.0 => {
            format!("emission on a hit counts although a light sample has found this light before{about}")
        }
        (Term::Hit, Factor::Occluded) => format!(
            "emission on a hit counts after a light sample that found nothing{about}; only after a delta bounce may it count"
        ),
        (_, factor) => match presence(factor) {
            Some(where_) if fact.expected == 0.0 => {
                format!("{term} contributes {where_}{about}, where nothing should arrive")
            }
            Some(where_) => format!("{term} is {seen} times what it should be {where_}{about}"),
            None => format!("{term} is {seen} times what it should be{about}"),
        },
    }
}

/// Name of a fact's factor in a table.
pub fn factor(fact: &Fact) -> String {
    let name = name(fact.term, fact.factor);
    match fact.place {
        Place::Lights(number) if fact.term == Term::Selection => count(number as usize, "light"),
        _ => name.to_owned(),
    }
}

/// Heading of the facts of a term.
pub fn heading(term: Term) -> &'static str {
    match term {
        Term::LightSample => "Light sample, area light",
        Term::PointLight => "Light sample, point light",
        Term::Hit => "Emission on a hit",
        Term::LightWeight => "MIS weight of the light sample",
        Term::HitWeight => "MIS weight of the hit",
        Term::Weights => "Sum of the two MIS weights",
        Term::Path => "Paths",
        Term::Roulette => "Russian roulette",
        Term::Selection => "Selection of a light",
        Term::Conduct => "Constants, rays and random numbers",
    }
}

/// The value of a fact as it stands in a table.
pub fn measured(fact: &Fact) -> String {
    match fact.outcome {
        Outcome::DoesNotApply(_) => "–".to_owned(),
        _ => value(fact.measured),
    }
}

/// The value of a correct estimator as it stands in a table.
pub fn expected(fact: &Fact) -> String {
    match fact.factor {
        Factor::Rise => "rises".to_owned(),
        _ => value(Some(fact.expected)),
    }
}

fn value(value: Option<f64>) -> String {
    match value {
        None => "NaN".to_owned(),
        Some(value) if value.abs() >= 0.01 && value.abs() < 1000.0 => trimmed(value, 3),
        Some(value) if value.abs() < 5e-4 => "0".to_owned(),
        Some(value) => significant(value),
    }
}

fn exponent(fact: &Fact, about: &str) -> String {
    let (term, name, expected) = (term(fact.term), name(fact.term, fact.factor), value(Some(fact.expected)));
    let ignores = fact.measured.is_some_and(|it| it.abs() < 0.02);
    match fact.measured {
        None => format!("{term} vanishes when {name} changes{about}"),
        Some(_) if ignores => format!("{term} ignores {name}{about}: exponent 0 instead of {expected}"),
        Some(seen) if fact.expected == 0.0 => format!(
            "{term} depends on {name}{about}, which should have no part in it: exponent {}",
            value(Some(seen))
        ),
        Some(seen) => {
            format!("{term} has {name} with the exponent {}{about} instead of {expected}", value(Some(seen)))
        }
    }
}

fn place(fact: &Fact) -> String {
    match fact.place {
        Place::Hit(1) => " at the first hit".to_owned(),
        Place::Hit(2) => " at the second hit".to_owned(),
        Place::Hit(3) => " at the third hit".to_owned(),
        Place::Hit(hit) => format!(" at hit {hit}"),
        Place::Lights(_) | Place::Paths => String::new(),
    }
}

fn lights(place: Place) -> String {
    match place {
        Place::Lights(number) => count(number as usize, "light"),
        _ => "the lights".to_owned(),
    }
}

fn term(term: Term) -> &'static str {
    match term {
        Term::LightSample | Term::Conduct => "the light sample of an area light",
        Term::PointLight => "the light sample of a point light",
        Term::Hit => "emission on a hit",
        Term::LightWeight => "the MIS weight of the light sample",
        Term::HitWeight => "the MIS weight of the hit",
        Term::Weights => "the sum of both MIS weights",
        Term::Path => "the light of a path",
        Term::Roulette => "a long path",
        Term::Selection => "a light",
    }
}

fn name(term: Term, factor: Factor) -> &'static str {
    let is_light = matches!(term, Term::LightSample | Term::PointLight | Term::LightWeight);
    match factor {
        Factor::Size if matches!(term, Term::LightWeight | Term::HitWeight) => "power of the heuristic",
        Factor::Size => "result / exact",
        Factor::PreviousBsdf => "f of the previous bounce",
        Factor::PreviousDensity => "the BSDF density of the previous bounce",
        Factor::Bsdf if is_light => "f in the direction to the light point",
        Factor::Bsdf => "f of the sampled direction",
        Factor::OtherBsdf if is_light => "f of the direction that the BSDF samples",
        Factor::OtherBsdf => "f in the direction of the light sample",
        Factor::ViewerBsdf => "f in the direction to the viewer",
        Factor::Density if is_light => "the BSDF density in the direction to the light point",
        Factor::Density => "the BSDF density of the sampled direction",
        Factor::OtherDensity if is_light => "the BSDF density of the direction that the BSDF samples",
        Factor::OtherDensity => "the BSDF density in the direction of the light sample",
        Factor::ViewerDensity => "the BSDF density in the direction to the viewer",
        Factor::ShadingCosine => "the cosine at the receiver",
        Factor::GeometricCosine => "the cosine at the receiver with the geometric normal",
        Factor::Emission => "the light's emission",
        Factor::OtherChannel => "the emission in another color channel",
        Factor::LightCosine => "the cosine at the light",
        Factor::Distance => "the distance",
        Factor::AreaDensity if is_light => "the area density of the sampled light point",
        Factor::AreaDensity => "the area density of the light point that is hit",
        Factor::OtherAreaDensity if is_light => "the area density of a light point that is hit",
        Factor::OtherAreaDensity => "the area density of another light point",
        Factor::Lights => "the number of lights",
        Factor::Occluded => "occluded",
        Factor::OccludedAtLight => "occluded close to the light",
        Factor::OccludedAtReceiver => "occluded close to the receiver",
        Factor::ObjectBehindLight => "an object behind the light",
        Factor::BelowHorizon => "light below the horizon",
        Factor::DeltaBsdf => "at a mirror",
        Factor::WithoutBsdfSample => "BSDF sampling returns nothing",
        Factor::Scale => "dim, bright, near, far",
        Factor::Sum => "one light",
        Factor::SumWithUnequalLights => "unequal lights",
        Factor::Rise => "from low to high density",
        Factor::SeenByCamera => "light seen by the camera",
        Factor::AfterDeltaBounces => "delta bounces only",
        Factor::AfterLaterDeltaBounce => "delta bounce after another bounce",
        Factor::AfterBounceBehindDelta => "bounce after a delta bounce",
        Factor::AfterBounces => "no delta bounce",
        Factor::AtLimit => "max_bounces bounces",
        Factor::BeyondLimit => "more than max_bounces bounces",
        Factor::WithoutLight => "no light on the path",
        Factor::GreyThroughput => "grey throughput below 1",
        Factor::ColoredThroughput => "a channel of the throughput is 0",
        Factor::HighThroughput => "throughput above 1",
        Factor::Repeatable => "the same call twice",
        Factor::ReflectedByLight => "at a point on another light",
        Factor::AfterMissedLightSample => "after a light that faces away",
        Factor::LongPath => "twelve bounces",
        Factor::Rays => "rays, with many lights",
        Factor::ExtremeDensities => "very small and large densities",
        Factor::RandomNumbers => "excess of equal paths in a row",
    }
}

/// Where a contribution is looked at, for facts about its presence.
fn presence(factor: Factor) -> Option<&'static str> {
    Some(match factor {
        Factor::Occluded => "where something stands between the light and the hit point",
        Factor::OccludedAtLight => "where something stands just before the light",
        Factor::OccludedAtReceiver => "where something stands just above the hit point",
        Factor::ObjectBehindLight => "where something stands behind the light",
        Factor::BelowHorizon => "where the light is below the horizon",
        Factor::DeltaBsdf => "at a mirror or glass",
        Factor::WithoutBsdfSample => "where BSDF sampling returns no direction",
        Factor::ReflectedByLight => "at a point that lies on another light",
        _ => return None,
    })
}

fn throughput(factor: Factor) -> &'static str {
    match factor {
        Factor::GreyThroughput => "falls below 1",
        Factor::ColoredThroughput => "is 0 in one channel only",
        _ => "rises above 1",
    }
}

fn path(fact: &Fact) -> String {
    let class = match fact.factor {
        Factor::SeenByCamera => "light that the camera sees directly",
        Factor::AfterDeltaBounces => "light after delta bounces only",
        Factor::AfterLaterDeltaBounce => "light after a delta bounce that follows another bounce",
        Factor::AfterBounceBehindDelta => "light after a bounce that follows a delta bounce",
        Factor::AfterBounces => "light after bounces without a delta bounce",
        Factor::AtLimit => "light after exactly `max_bounces` bounces",
        Factor::BeyondLimit => "light after more than `max_bounces` bounces",
        Factor::AfterMissedLightSample => {
            "light on a path whose first hit point sees no sampled light, since that faces away,"
        }
        Factor::LongPath => "light after twelve bounces, where `max_bounces` allows them,",
        _ => "a path that never meets a light",
    };
    let example =
        fact.example.as_ref().map_or_else(String::new, |word| format!(", for example {}", self::word(word)));
    let seen = value(fact.measured);
    if fact.expected == 0.0 {
        format!("{class} contributes {seen} instead of 0 (`{}`){example}", fact.technique)
    } else {
        format!("{class} is {seen} times what it should be (`{}`){example}", fact.technique)
    }
}

/// "camera – diffuse – mirror – area light with max_bounces 2".
fn word(word: &PathWord) -> String {
    let surface = |kind: &SurfaceKind| match kind {
        SurfaceKind::Diffuse => "diffuse",
        SurfaceKind::Glossy => "glossy",
        SurfaceKind::Mirror => "mirror",
        SurfaceKind::Glass => "glass",
        SurfaceKind::Coated => "diffuse with a mirror coat",
    };
    let end = match word.end {
        PathEnd::AreaLight => "area light",
        PathEnd::PointLight => "point light",
        PathEnd::Nothing => "nothing",
    };
    let mut parts = vec!["camera"];
    parts.extend(word.surfaces.iter().map(surface));
    parts.push(end);
    format!("{} with max_bounces {}", parts.join(" – "), word.max_bounces)
}

/// The facts of an audit by row of a table: those that differ in the hit only.
pub fn audit_rows(audit: &verdict::audit::Audit) -> Vec<Vec<&Fact>> {
    let mut rows: Vec<Vec<&Fact>> = Vec::new();
    for fact in &audit.facts {
        let same = |row: &&mut Vec<&Fact>| {
            let first = row[0];
            let is_hit = |fact: &Fact| matches!(fact.place, Place::Hit(_));
            (first.term, first.factor, first.technique) == (fact.term, fact.factor, fact.technique)
                && is_hit(first)
                && is_hit(fact)
        };
        match rows.iter_mut().find(same) {
            Some(row) => row.push(fact),
            None => rows.push(vec![fact]),
        }
    }
    // Terms together, in the order of their first facts.
    let mut order = Vec::new();
    for row in &rows {
        let key = (row[0].term, row[0].technique);
        if !order.contains(&key) {
            order.push(key);
        }
    }
    rows.sort_by_key(|row| order.iter().position(|key| *key == (row[0].term, row[0].technique)));
    rows
}
