use super::*;

#[test]
fn means_say_how_far_off_and_where() {
    let tile = Some([[4, 7], [8, 8]]);
    for (kind, pixels, effect, expected) in [
        (RegionKind::Weighted, None, Some(-0.125), "the mean is 12.5 % too dark"),
        (RegionKind::Luminance, None, Some(0.02), "the mean is 2 % too bright"),
        (RegionKind::Luminance, None, Some(1.0), "the mean is 2 times what it should be"),
        (RegionKind::Weighted, None, Some(-1.0), "the image is black"),
        (RegionKind::Weighted, None, None, "the image should be black, but is not"),
        (
            RegionKind::Channel(Channel::Red),
            None,
            Some(-0.1),
            "the mean is 10 % too dark, clearest in the red channel",
        ),
        (
            RegionKind::Channel(Channel::Blue),
            tile,
            Some(-0.1),
            "the mean is 10 % too dark in columns 4–7, row 8, clearest in the blue channel",
        ),
        (
            RegionKind::Pattern,
            None,
            Some(-0.042),
            "the means are 4.2 % off: the bias changes sign across the image",
        ),
    ] {
        let test = MeanTest { region: RegionId { kind, pixels }, effect, ..mean_test() };
        assert_eq!(fails(Evidence::MeanBias(test.clone())), expected);
        assert_eq!(fails(Evidence::ClosedForm(test)), expected);
    }
}

#[test]
fn means_that_are_right_or_too_noisy_say_how_well_they_are_known() {
    let right = MeanTest { effect: Some(0.001), interval: Some([-0.003, 0.005]), ..mean_test() };
    assert_eq!(passes(Evidence::MeanBias(right)), "the mean is correct to within 0.5 % (2 % allowed)");
    for (detectable, expected) in [
        (Some(8.473), "too noisy to judge"),
        (None, "too noisy to judge"),
        (Some(0.073), "too noisy to judge: an error of 7.3 % could go unnoticed, and 2 % is allowed"),
    ] {
        let mut check =
            check(Verdict::Inconclusive, Evidence::MeanBias(MeanTest { detectable, ..mean_test() }));
        assert_eq!(explanation(&check), expected);
        check.short_look = true;
        assert_eq!(explanation(&check), format!("{expected}; stopped early because a required check failed"));
    }
}

#[test]
fn changed_and_random_scenes_say_which_one_decided() {
    let change =
        || ChangeTest { change: SceneChange::Rotated, changes: 9, is_biased: true, test: mean_test() };
    let variant = || VariantTest { scene: 1, scenes: 2, test: mean_test() };
    for (text, expected) in [
        (passes(Evidence::Metamorphic(change())), "9 scene changes had the expected effect"),
        (fails(Evidence::Metamorphic(change())), "with the scene rotated, the mean is 12.5 % too dark"),
        (fails(Evidence::HiddenVariants(variant())), "in scene 1 of 2, the mean is 12.5 % too dark"),
        (
            fails(Evidence::WhiteFurnace(furnace_test())),
            "with at most 1 bounce, the mean is 12.5 % too dark; energy per bounce relative to exact: 1.00, 0.50",
        ),
    ] {
        assert_eq!(text, expected);
    }
}

#[test]
fn bad_samples_and_faults_decide_whatever_the_mean() {
    let first = Some(anomaly());
    for (non_finite, negative, expected) in [
        (4, 0, "4 samples are NaN or infinite"),
        (1, 0, "1 sample is NaN or infinite"),
        (0, 2, "2 samples are negative"),
        (4, 1, "4 samples are NaN or infinite and 1 is negative"),
    ] {
        let mut check = check(Verdict::Fail, Evidence::MeanBias(mean_test()));
        check.numerics = Numerics { non_finite, negative, first: first.clone() };
        let first = "; the first is sample 5 of pixel (3, 4), with the value (NaN, 0.5, 0)";
        assert_eq!(explanation(&check), format!("{expected}{first}"));
        assert!(replay_of(&check, "a").is_some_and(|command| command.contains("--pixel=3,4")));
    }
    for (fault, expected) in [
        (Fault::Panic("index out of bounds".to_owned()), "the program panicked: index out of bounds"),
        (Fault::Timeout(29.998172652), "the program did not finish within 30 s"),
        (
            Fault::TooSlow(3.75),
            "the program is too slow: it did not finish an eighth of its work within 3.8 s",
        ),
        (Fault::Crash("signal 9".to_owned()), "the program ended unexpectedly (signal 9)"),
        (Fault::Malformed("3 pixels".to_owned()), "the program's answer was malformed (3 pixels)"),
    ] {
        let check =
            CheckResult { fault: Some(fault), ..check(Verdict::Fail, Evidence::MeanBias(mean_test())) };
        assert_eq!(explanation(&check), expected);
    }
}
