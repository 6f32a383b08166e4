use super::*;

/// Width and height of the pictures below.
const SIZE: (usize, usize) = (48, 32);

/// A test picture with a ripple and one firefly, and its reference: a blob and a step.
fn pictures() -> (Vec<[f64; 3]>, Vec<[f64; 3]>) {
    let (width, height) = SIZE;
    let mut reference = Vec::new();
    let mut picture = Vec::new();
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x as f64, y as f64))) {
        let blob = 2.0 * (-((x - 20.0).powi(2) + (y - 12.0).powi(2)) / 40.0).exp();
        let step = if x > 30.0 { 1.0 } else { 0.0 };
        let colors = [(1.0, 0.2), (0.6, 0.5), (0.3, 0.1)];
        let pixel = colors.map(|(of_blob, of_step)| 0.05 + blob * of_blob + step * of_step);
        reference.push(pixel);
        picture.push(pixel.map(|value| value * (1.0 + 0.3 * (1.3 * x + 0.7 * y).sin())));
    }
    picture[5 * width + 5] = [20.0; 3];
    (picture, reference)
}

#[test]
fn values_match_the_authors_implementation() {
    // flip-evaluator 1.7 (Python), `evaluate(reference, test, "HDR", inputsRGB=False, applyMagma=False)`.
    let (picture, reference) = pictures();
    let flip = hdr_flip(&picture, &reference, SIZE.0, SIZE.1).expect("the pictures have pixels");
    let (first, last, steps) = flip.exposures;
    assert!(
        (first - 0.622_020).abs() < 1e-4 && (last - 2.975_947).abs() < 1e-4 && steps == 3,
        "{first} {last}"
    );
    assert!((flip.mean - 0.111_185).abs() < 1e-4, "{}", flip.mean);
    for ((x, y), expected) in [
        ((5, 5), 0.570_198),
        ((0, 0), 0.154_121),
        ((20, 12), 0.031_392),
        ((31, 20), 0.150_752),
        ((47, 31), 0.196_382),
        ((9, 6), 0.103_529),
    ] {
        let value = flip.map[y * SIZE.0 + x];
        assert!((value - expected).abs() < 2e-4, "({x}, {y}): {value}, not {expected}");
    }
}

#[test]
fn uniform_colours_match_the_authors_implementation() {
    let flip = |a: [f64; 3], b: [f64; 3]| super::flip(&[a; 81], &[b; 81], 9, 9)[40];
    for (a, b, expected) in [
        ([0.0, 1.0, 0.0], [0.0, 0.0, 1.0], 1.0),
        ([0.0; 3], [1.0; 3], 0.967_389),
        ([0.2; 3], [0.3; 3], 0.284_729),
        ([1.0, 0.0, 0.0], [0.5, 0.5, 0.1], 0.957_604),
    ] {
        assert!((flip(a, b) - expected).abs() < 1e-4, "{a:?} {b:?}: {}", flip(a, b));
    }
}

#[test]
fn equal_pictures_have_no_difference_and_invalid_values_count_as_black() {
    let (_, reference) = pictures();
    let same = hdr_flip(&reference, &reference, SIZE.0, SIZE.1).expect("it has pixels");
    assert_eq!(same.mean, 0.0);
    let broken = [[f64::NAN, f64::INFINITY, -1.0]; 4];
    let flip = hdr_flip(&broken, &[[0.0; 3]; 4], 2, 2).expect("it has pixels");
    assert_eq!(flip.mean, 0.0, "all of it counts as black");
    assert!(hdr_flip(&broken, &[[1.0; 3]; 4], 2, 2).expect("it has pixels").mean > 0.9);
    assert_eq!(hdr_flip(&[], &[], 0, 0), None);
    assert_eq!(hdr_flip(&broken, &broken, 3, 2), None);
}
