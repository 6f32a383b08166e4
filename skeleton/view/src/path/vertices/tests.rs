use super::*;

const AREAS: [bool; 2] = [true, true];

type Values<'a> = &'a [(&'static str, &'a [f32])];

fn call(function: &'static str, given: Values<'_>, got: Values<'_>) -> Call {
    let owned = |values: Values<'_>| {
        values.iter().map(|(name, numbers)| ((*name).into(), numbers.to_vec())).collect()
    };
    Call { function, given: owned(given), got: owned(got) }
}

/// A hit of a ray along `direction` at `point`.
fn hit(direction: [f32; 3], point: [f32; 3], normal: [f32; 3]) -> Call {
    let given: Values<'_> = &[("origin", &[0.0, 0.0, 0.0]), ("direction", &direction)];
    call("Scene::intersect", given, &[("point", &point), ("normal", &normal)])
}

/// A sample of light 1 at height 2 above the origin: density 0.5 per area, 0.5 · 2² / 1 / 2 lights = 1 per solid angle.
fn light_sample() -> Call {
    let got: Values<'_> = &[
        ("point", &[0.0, 2.0, 0.0]),
        ("emitted", &[4.0, 4.0, 4.0]),
        ("pdf_area", &[0.5]),
        ("cos_light", &[1.0]),
    ];
    call("Light::sample_direct", &[("light", &[1.0]), ("from", &[0.0, 0.0, 0.0])], got)
}

const UP: &[f32] = &[0.0, 1.0, 0.0];

/// The calls of next event estimation at a point on the floor, with both densities.
fn direct(occluded: f32) -> Vec<Call> {
    vec![
        hit([0.0, -1.0, 0.0], [0.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
        light_sample(),
        call("Bsdf::eval", &[("wi", UP)], &[("f", &[0.25, 0.25, 0.25])]),
        call("Scene::occluded", &[("point", &[0.0, 2.0, 0.0])], &[("occluded", &[occluded])]),
        call("Bsdf::pdf", &[("wi", UP)], &[("pdf", &[3.0])]),
    ]
}

/// A bounce upwards from the floor and a hit of light 1.
fn bounce(is_delta: f32) -> Vec<Call> {
    let sample: Values<'_> =
        &[("wi", UP), ("f", &[0.5, 0.5, 0.5]), ("pdf", &[3.0]), ("cos", &[1.0]), ("is_delta", &[is_delta])];
    let emission: Values<'_> =
        &[("light", &[1.0]), ("radiance", &[4.0, 4.0, 4.0]), ("pdf_area", &[0.5]), ("cos_light", &[1.0])];
    vec![
        call("Bsdf::sample", &[], sample),
        hit([0.0, 1.0, 0.0], [0.0, 2.0, 0.0], [0.0, -1.0, 0.0]),
        call("Hit::emission", &[("point", &[0.0, 2.0, 0.0])], emission),
    ]
}

fn path(technique: Technique, calls: Vec<Call>) -> Path {
    Path::new(&RecordedPath { sample: 3, radiance: Rgb::WHITE, calls }, technique, &AREAS)
}

#[test]
fn a_light_sample_adds_what_the_sheet_says() {
    let sample = |technique, occluded| path(technique, direct(occluded)).vertices[0].light_samples[0].clone();
    let nee = sample(Technique::Nee, 0.0);
    assert_eq!((nee.arrives, nee.found.light, nee.found.p_ne), (Some(true), 1, Some(1.0)));
    // 4 · 0.25 · cos 0° / p_ne = 1.
    assert_eq!((nee.found.weight, nee.found.contribution), (1.0, Rgb::WHITE));
    let mis = sample(Technique::Mis, 0.0);
    assert_eq!(
        (mis.found.p_brdf, mis.found.weight, mis.found.contribution),
        (Some(3.0), 0.25, Rgb::gray(0.25))
    );
    let blocked = sample(Technique::Nee, 1.0);
    assert_eq!((blocked.arrives, blocked.found.contribution), (Some(false), Rgb::BLACK));
}

#[test]
fn weights_of_both_ways_to_find_a_light_sum_to_one() {
    let path = path(Technique::Mis, [direct(0.0), bounce(0.0)].concat());
    assert_eq!(path.vertices.len(), 2);
    let (sampled, hit) =
        (path.vertices[0].light_samples[0].found, path.vertices[1].emission.expect("a light"));
    assert_eq!((sampled.p_ne, sampled.p_brdf), (hit.p_ne, hit.p_brdf));
    assert_eq!(sampled.weight + hit.weight, 1.0);
    assert_eq!(path.sum(), sampled.contribution + hit.contribution);
}

#[test]
fn a_light_that_is_hit_counts_by_technique_and_fully_after_a_delta_bounce() {
    let weight = |technique, is_delta| {
        let path = path(technique, [direct(0.0), bounce(is_delta)].concat());
        path.vertices[1].emission.map(|found| found.weight)
    };
    assert_eq!(Technique::ALL.map(|technique| weight(technique, 0.0)), [Some(1.0), Some(0.0), Some(0.75)]);
    assert_eq!(Technique::ALL.map(|technique| weight(technique, 1.0)), [Some(1.0); 3]);
}

#[test]
fn a_shadow_ray_may_look_at_what_it_hits() {
    for (light, arrives) in [([1.0], true), ([0.0], false)] {
        let mut calls = direct(0.0);
        let seen: Values<'_> =
            &[("point", &[0.0, 2.0, 0.0]), ("normal", &[0.0, -1.0, 0.0]), ("light", &light)];
        calls[3] = call("Scene::intersect", &[("origin", &[0.0, 0.0, 0.0]), ("direction", UP)], seen);
        let path = path(Technique::Nee, calls);
        assert_eq!(path.vertices.len(), 1, "it is not a vertex");
        assert_eq!(path.vertices[0].light_samples[0].arrives, Some(arrives));
    }
}

#[test]
fn roulette_is_noticed_between_two_bounces_only() {
    let number = || call("Sampler::next_1d", &[], &[("number", &[0.5])]);
    let picks_a_light =
        [vec![hit([0.0, -1.0, 0.0], [0.0; 3], [0.0, 1.0, 0.0]), number()], bounce(0.0)].concat();
    assert!(!path(Technique::Nee, picks_a_light).roulette);
    let mut calls = [direct(0.0), bounce(0.0)].concat();
    calls.insert(6, number());
    assert!(path(Technique::Nee, calls).roulette);
}

#[test]
fn calls_without_a_hit_are_no_trouble() {
    let calls = [bounce(0.0), direct(0.0)].concat().into_iter().rev().collect();
    let backwards = path(Technique::Mis, calls);
    assert!(backwards.sum().is_finite());
    let missed = call("Scene::intersect", &[("origin", &[1.0, 0.0, 0.0]), ("direction", UP)], &[]);
    let path = path(Technique::Mis, vec![missed]);
    assert_eq!((path.origin, path.escaped, path.vertices.len()), (Vec3::X, Some(Vec3::Y), 0));
}
