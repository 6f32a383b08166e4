use super::*;

#[test]
fn noise_names_the_technique_that_is_missing() {
    let noise = |ratio: f64, as_noisy_as| Noise {
        ratios: vec![VarianceOf { technique: Technique::Nee, ratio }],
        as_noisy_as,
        is_noisier: ratio > 1.5,
    };
    for (text, expected) in [
        (
            passes(Evidence::Efficiency(noise(1.02, None))),
            "1.02 times the variance of the solution with `nee`",
        ),
        (
            fails(Evidence::Efficiency(noise(36.4, Some(Technique::Bsdf)))),
            "36 times the variance of the solution with `nee`, as much as BSDF sampling: light samples do not reduce it",
        ),
        (
            fails(Evidence::Efficiency(Noise { ratios: Vec::new(), ..noise(1.0, None) })),
            "the image has no noise at all: every sample is the same",
        ),
    ] {
        assert_eq!(text, expected);
    }
    let noisier = check(Verdict::Pass, Evidence::Efficiency(noise(2.5, None)));
    let expected = "correct, but with 2.5 times the variance of the solution at the same number of samples";
    assert_eq!(remarks(&noisier), [expected]);
}

#[test]
fn selection_is_only_blamed_where_lights_differ() {
    let shares = |excess, wrong| Evidence::LightPick(LightShares { excess, wrong });
    for (excess, expected) in [
        (
            [Some(-0.667), Some(0.0), Some(0.2)],
            "light 1 of 3 contributes 33 % of what it should: the selection probability you divide by is not the one you \
             sample with",
        ),
        (
            [Some(-0.0034), Some(0.0), Some(0.2)],
            "light 1 of 3 contributes 99.66 % of what it should: the selection probability you divide by is not the one \
             you sample with",
        ),
        (
            [Some(-2.0 / 3.0); 3],
            "each of the three lights contributes 33 % of what it should: divide by the selection probability",
        ),
        ([Some(1.0); 3], "each of the three lights contributes 200 % of what it should"),
        ([None, Some(0.0), Some(0.0)], "light 1 of 3 contributes NaN or infinity"),
    ] {
        assert_eq!(fails(shares(excess, Some(0))), expected);
    }
    let with = |technique, excess: [Option<f64>; 3], wrong| {
        let mut check = check(Verdict::Fail, shares(excess, wrong));
        check.id.technique = technique;
        explanation(&check)
    };
    assert_eq!(
        with(Technique::Mis, [Some(-0.23); 3], Some(0)),
        "each of the three lights contributes 77 % of what it should: a path never hits a point light, so what weight must its \
         light sample have?"
    );
    assert_eq!(
        with(Technique::Bsdf, [Some(1.0); 3], Some(0)),
        "point light 1 contributes 100 % of what a light sample finds, although BSDF sampling never hits it: light samples \
         count with this technique, too"
    );
    assert_eq!(with(Technique::Bsdf, [Some(0.0); 3], None), "no light is sampled, as it should be");
    assert_eq!(passes(shares([Some(0.0); 3], None)), "each of the three lights contributes what it should");
}

#[test]
fn long_paths_of_bsdf_sampling() {
    let said = |excess| {
        let rays = Evidence::RayBudget(RayCounts {
            excess,
            lights: 8,
            shadow_rays_at_mirrors: false,
            shadow_rays_without_lights: false,
            panic_without_lights: None,
        });
        let mut check = check(Verdict::Fail, rays);
        check.id.technique = Technique::Bsdf;
        explanation(&check)
    };
    assert_eq!(said(None), "most long paths end early");
    assert_eq!(
        said(Some(TooManyRays { bounces: 64, shadow_rays: 0, rays: 65, allowed: 32 })),
        "a path of up to 64 bounces traces 65 rays on average; Russian roulette leaves less than 32 between dark walls"
    );
}

#[test]
fn random_numbers_and_rays() {
    let shared = RandomNumbers::SharedByPixels { excess: 3.11, pixels: PixelGroup::Row };
    let rays = |excess| {
        Evidence::RayBudget(RayCounts {
            excess,
            lights: 8,
            shadow_rays_at_mirrors: true,
            shadow_rays_without_lights: true,
            panic_without_lights: None,
        })
    };
    let panicked = |excess| {
        let Evidence::RayBudget(rays) = rays(excess) else { unreachable!("it is a budget of rays") };
        let message = "index out of bounds (render_pt.rs:70)".to_owned();
        fails(Evidence::RayBudget(RayCounts { panic_without_lights: Some(message), ..rays }))
    };
    let too_many = |bounces, shadow_rays, rays| {
        Some(TooManyRays { bounces, shadow_rays, rays, allowed: 1 + 3 * bounces })
    };
    for (text, expected) in [
        (
            passes(Evidence::Randomness(RandomNumbers::Independent)),
            "pixels, batches and seeds are independent and repeatable",
        ),
        (
            fails(Evidence::Randomness(RandomNumbers::SameImage([0, 3]))),
            "different seeds give the same image (batches 0 and 3): the random numbers do not come from the sampler",
        ),
        (
            fails(Evidence::Randomness(shared)),
            "pixels share random numbers: sums over rows have 3.1 times the variance of independent pixels",
        ),
        (
            panicked(None),
            "the program panics in a scene without lights: index out of bounds (render_pt.rs:70); there is no light to select, \
             so return black before you select one. With lights, it traces at most one shadow ray per bounce",
        ),
        (passes(rays(None)), "at most one shadow ray per bounce"),
        (
            fails(rays(too_many(1, 8, 10))),
            "8 shadow rays on a path of 1 bounce, in a room with 8 lights: the sheet asks for one per bounce",
        ),
        (
            fails(rays(too_many(3, 1, 40))),
            "40 rays on a path of 3 bounces, in a room with 8 lights: 10 rays are enough, even if shadow rays and BSDF \
             samples are traced separately",
        ),
    ] {
        assert_eq!(text, expected);
    }
    assert_eq!(remarks(&check(Verdict::Pass, rays(None))).len(), 2);
}
