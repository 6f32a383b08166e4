use super::*;

#[test]
fn stability_names_place_deviation_and_cause() {
    let finding = |place, deviation, likely_cause, is_graded| StabilityFinding {
        place,
        deviation,
        likely_cause,
        is_graded,
        first: None,
        replay: Some(target()),
    };
    let nan = StabilityFinding {
        first: Some(anomaly()),
        ..finding(
            Place::Scaled(-10),
            Deviation::Anomalies { non_finite: 4, negative: 0 },
            NumericalCause::InvalidOperation,
            true,
        )
    };
    let sum = finding(
        Place::Densities { light: Float(1e12), bsdf: Float(1e-12) },
        Deviation::WeightSum { sum: Float(2.0), pairs: [3, 25] },
        NumericalCause::OverflowPatchedToOne,
        false,
    );
    let region = finding(
        Place::Brightened(10),
        Deviation::Region { pixels: None, relative: Float(-0.25), expected: Float(1.0) },
        NumericalCause::ClampedRadiance { limit: Float(10.0), samples: 7 },
        true,
    );
    let mean = finding(
        Place::ExtremeScene("tiny".to_owned()),
        Deviation::Mean { found: Float(0.0), expected: Float(1.5), because: "uniform".to_owned() },
        NumericalCause::FixedEpsilon { size: 1e-3, is_large: true },
        true,
    );
    let of = |findings: Vec<StabilityFinding>| Evidence::Stability(StabilityTest { findings });
    for (text, expected) in [
        (
            fails(of(vec![nan.clone()])),
            "in a scene 2⁻¹⁰ times as large, 4 samples are NaN or infinite; the first is sample 5 of pixel (3, 4), with the \
             value (NaN, 0.5, 0); likely cause: 0/0, ∞/∞, or the square root or arc cosine of a number out of range",
        ),
        (
            fails(of(vec![region, sum.clone()])),
            "with lights 2¹⁰ times as bright, the mean is 25 % too dark, compared with the unchanged scene; likely cause: \
             radiance is clamped to 10: 7 samples have exactly this value",
        ),
        (
            fails(of(vec![mean.clone(), nan.clone()])),
            "in tiny, the mean is 0 instead of 1.5 (uniform); likely cause: a fixed epsilon or minimum distance, which is \
             large in a scene 1e-3 units large; 1 more finding is among the remarks",
        ),
        (
            passes(of(vec![sum.clone()])),
            "correct for scales and radiances from 1/1024 to 1024 and densities from 1e-12 to 1e12; 1 remark outside this range",
        ),
    ] {
        assert_eq!(text, expected);
    }
    let check = check(Verdict::Fail, of(vec![nan, sum]));
    let remark = "with a density per solid angle of 1e12 for the light sample and 1e-12 for the BSDF sample, the two weights \
        sum to 2 instead of 1 (3 of 25 pairs of densities); likely cause: where a square or sum of densities is infinite, \
        both weights are set to 1";
    assert_eq!(remarks(&check), [remark]);
    let replay = "cargo grader replay 'my file.rs' --scene=box --pixel=3,4 --sample=5 --technique=nee --max-bounces=8 \
        --seed=7 --size=32x24";
    assert_eq!(replay_of(&check, "my file.rs").as_deref(), Some(replay));
    assert_eq!(remarks_with_replay(&check, "my file.rs"), [format!("{remark}; replay: {replay}")]);
}
