//! Tests of the grader's own arithmetic near the limits of floating-point numbers: results are right, and never NaN.

use super::batches::Batches;
use super::bias::{Comparison, combined_p_value, min_p_value};
use super::expected::Expected;
use super::regions::{pyramid, weighted_image};
use super::sequential::{Decision, Judgement, LOOKS, SampleRequest, SequentialTest, judge};

const SIZE: u32 = 8;
const PIXELS: usize = (SIZE * SIZE) as usize;

/// The expectation for an estimator whose samples have this mean, standard deviation and skewness.
fn expected(mean: f64, deviation: f64, skewness: f64) -> Expected {
    Expected {
        mean: vec![[mean; 3]; PIXELS],
        error: vec![[0.0; 3]; PIXELS],
        deviation: vec![[deviation; 3]; PIXELS],
        asymmetry: vec![[skewness.cbrt() * deviation; 3]; PIXELS],
    }
}

fn decide(expected: &Expected, mut pixel: impl FnMut(u64, usize) -> f32) -> Judgement {
    let mut regions = pyramid(SIZE, SIZE);
    regions.push(weighted_image(expected));
    let test = SequentialTest {
        expected,
        regions: &regions,
        decisive: regions.len() - 1,
        tolerance: 0.02,
        screening_level: 0.01,
        seed: 1,
        looks: LOOKS.len(),
    };
    let render = |request: &SampleRequest| {
        let mut batch = |&seed: &u64| (0..PIXELS).map(|index| [pixel(seed, index); 3]).collect();
        Ok::<_, ()>(request.seeds.iter().map(&mut batch).collect())
    };
    judge(&test, render).expect("it cannot fail")
}

/// Asserts that no number of a comparison is NaN. Those of an infinite difference may be infinite.
fn assert_no_nan(comparison: &Comparison) {
    for value in [
        comparison.difference,
        comparison.standard_error,
        comparison.t(),
        comparison.p_value(),
        comparison.one_sided_p_value(1.0),
        comparison.one_sided_p_value(-1.0),
        comparison.relative(),
        comparison.relative_margin(0.99),
        comparison.detectable(1e-4),
    ] {
        assert!(!value.is_nan(), "{comparison:?}");
    }
    assert!((0.0..=1.0).contains(&comparison.p_value()), "{comparison:?}");
}

fn decision(expected: &Expected, pixel: impl FnMut(u64, usize) -> f32) -> Decision {
    let judgement = decide(expected, pixel);
    assert_no_nan(&judgement.comparison);
    assert!(!judgement.detectable.is_nan());
    judgement.decision
}

#[test]
fn images_without_variance_are_decided() {
    for value in [1e-38f32, 1e-20, 1.0, 1e20, 1e38] {
        let exact = expected(f64::from(value), 0.0, 0.0);
        assert_eq!(decision(&exact, |_, _| value), Decision::Unbiased, "{value:e}");
        assert_eq!(decision(&exact, |_, _| 1.05 * value), Decision::Biased, "{value:e}");
        assert_eq!(decision(&exact, |_, _| 0.0), Decision::Biased, "{value:e}");
    }
}

#[test]
fn black_images_are_right_where_black_is_expected_and_wrong_elsewhere() {
    let black = expected(0.0, 0.0, 0.0);
    assert_eq!(decision(&black, |_, _| 0.0), Decision::Unbiased);
    assert_eq!(decision(&black, |_, _| 1e-30), Decision::Biased);
    assert_eq!(decision(&expected(1.0, 0.5, 1.0), |_, _| 0.0), Decision::Biased);
}

#[test]
fn one_firefly_is_inconclusive() {
    let expected = expected(1.0, 0.1, 0.0);
    for firefly in [1e10f32, 1e30, f32::MAX] {
        // One pixel of the first batch, in every request.
        let mut first = None;
        let decision = decision(&expected, |seed, pixel| {
            let first = *first.get_or_insert(seed);
            if pixel == 5 && seed == first { firefly } else { 1.0 }
        });
        assert_eq!(decision, Decision::Unclear, "{firefly:e}");
    }
}

#[test]
fn few_batches_of_ten_million_samples_are_counted_correctly() {
    let regions = pyramid(SIZE, SIZE);
    let expected = expected(1.0, 0.5, 2.0);
    for count in [1, 2, 3] {
        let mut batches = Batches::default();
        let means: Vec<Vec<[f32; 3]>> =
            (0..count).map(|batch| vec![[1.0 + 0.01 * batch as f32; 3]; PIXELS]).collect();
        batches.extend(&means, 10_000_000);
        batches.extend(&means, 10_000_000);
        assert_eq!(batches.samples_per_pixel(), 20_000_000 * count as u64);
        for region in regions.iter().chain([&weighted_image(&expected)]) {
            let comparison = Comparison::new(&batches, &expected, region);
            assert_no_nan(&comparison);
            // A difference of one or two standard errors of so few batches is not significant.
            assert!(comparison.p_value() > 1e-3 || count == 1, "{count}: {comparison:?}");
        }
    }
    let empty = Batches::default();
    assert_eq!((empty.count(), empty.samples_per_pixel()), (0, 0));
}

#[test]
fn expectations_of_any_magnitude_give_finite_weights() {
    for mean in [0.0, 1e-45, 1e-30, 1.0, 1e30, 3e38] {
        for deviation in [0.0, 1e-3, 1.0, 1e6] {
            let region = weighted_image(&expected(mean, deviation * mean, 1.0));
            let sum: f64 = region.weights.iter().flat_map(|(_, weights)| weights).sum();
            assert!(sum.is_finite(), "{mean:e}, {deviation:e}");
            assert!(mean == 0.0 || (sum - 1.0).abs() < 1e-9, "{mean:e}, {deviation:e}: {sum}");
        }
    }
}

#[test]
fn p_values_stay_between_zero_and_one() {
    for p in [0.0, f64::MIN_POSITIVE, 1e-300, 0.5, 1.0] {
        for count in [1, 64, 100_000] {
            assert!((0.0..=1.0).contains(&min_p_value(count, p)), "{p:e}, {count}");
            assert!((0.0..=1.0).contains(&combined_p_value(&vec![p; count.min(64)])), "{p:e}, {count}");
        }
    }
}
