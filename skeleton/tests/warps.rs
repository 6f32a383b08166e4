//! Sampling routines agree with their densities.
//!
//! Each routine is inverted: if its density is correct, the distribution function of its results is uniform.
//! Nine χ² tests at 1e-5 each: a correct program fails with a probability below 1e-4 (seeds are fixed).

mod common;

use std::f64::consts::TAU;

use arty::math::{Vec3, warp};
use arty::sampler::Sampler;
use common::quadrature::{Polar, over_ring};
use common::statistics::uniformity;

const ALPHA: f64 = 1e-5;
const SAMPLES: usize = 200_000;
const CELLS: usize = 24;

fn numbers(seed: u64) -> impl Iterator<Item = (f32, f32)> {
    let mut sampler = Sampler::new(seed, (0, 0), 0);
    (0..SAMPLES).map(move |_| sampler.next_2d())
}

fn turn(x: f32, y: f32) -> f64 {
    (f64::from(y).atan2(f64::from(x)) / TAU).rem_euclid(1.0)
}

#[test]
fn points_in_the_disk_are_uniform() {
    let points = numbers(1).map(warp::disk).map(|p| (p.as_dvec2().length_squared(), turn(p.x, p.y)));
    let p = uniformity(CELLS, points);
    assert!(p > ALPHA, "{p}");
}

#[test]
fn directions_in_the_hemisphere_are_proportional_to_the_cosine() {
    // ∫ cos θ / π dω up to θ is sin² θ.
    let points = numbers(2).map(warp::cosine_hemisphere).map(|w| {
        assert!(w.z > 0.0 && (w.length() - 1.0).abs() < 1e-6, "{w}");
        (1.0 - f64::from(w.z).powi(2), turn(w.x, w.y))
    });
    let p = uniformity(CELLS, points);
    assert!(p > ALPHA, "{p}");
}

#[test]
fn directions_in_a_lobe_are_proportional_to_the_power_of_the_cosine() {
    let polar = Polar::around(glam::DVec3::Z);
    for (seed, exponent) in [(10, 0.0), (11, 1.0), (12, 10.0), (13, 1e3), (14, 1e6), (15, 1e9)] {
        // ∫ (n + 1) / 2π cosⁿ α dω beyond α is cosⁿ⁺¹ α.
        let points = numbers(seed).map(|u| warp::cosine_power(u, exponent)).map(|w| {
            assert!(w.z >= 0.0 && (w.length() - 1.0).abs() < 1e-6, "{w}");
            let (t, turn) = polar.coordinates(w);
            (((f64::from(exponent) + 1.0) * (-t.min(1.0)).ln_1p()).exp(), turn)
        });
        let p = uniformity(CELLS, points);
        assert!(p > ALPHA, "exponent {exponent}: {p}");
    }
}

#[test]
fn points_in_a_triangle_are_uniform() {
    let points = numbers(3).map(warp::triangle).map(|[b, c]| {
        assert!(b >= 0.0 && c >= 0.0 && b + c <= 1.0, "{b} {c}");
        let (b, c) = (f64::from(b), f64::from(c));
        // The area below a sum of b and c is proportional to its square, and b is uniform for a given sum.
        ((b + c).powi(2), if b + c > 0.0 { c / (b + c) } else { 0.0 })
    });
    let p = uniformity(CELLS, points);
    assert!(p > ALPHA, "{p}");
}

#[test]
fn densities_of_directions_integrate_to_one() {
    // 1 − cos α up to the horizon, where the densities vanish, that of exponent 0 with a jump.
    const HEMISPHERE: (f64, f64) = (0.0, 1.0);
    let polar = Polar::around(glam::DVec3::Z);
    let cosine =
        over_ring(&polar, HEMISPHERE, (0.0, 1.0), 256, &|w| f64::from(warp::cosine_hemisphere_pdf(w.z)));
    assert!((cosine - 1.0).abs() < 1e-4, "{cosine}");
    for exponent in [0.0, 1.0, 10.0, 1e3, 1e6] {
        let lobe = over_ring(&polar, HEMISPHERE, (0.0, 1.0), 128, &|w| {
            f64::from(warp::cosine_power_pdf(warp::power_of_cosine(Vec3::Z, w, exponent), exponent))
        });
        // The rounding of a direction is an angle of 6e-8 rad, 1e-4 of the width of the lobe with the exponent 1e6.
        assert!((lobe - 1.0).abs() < 5e-4, "exponent {exponent}: {lobe}");
    }
}

#[test]
fn the_corners_of_the_unit_square_give_valid_directions() {
    let largest = 1.0 - f32::EPSILON / 2.0;
    for u in [0.0, 0.5, largest] {
        for v in [0.0, 0.5, largest] {
            assert!(warp::disk((u, v)).length() <= 1.0 + 1e-6);
            for w in [0.0, 1.0, 1e6, 1e9].map(|exponent| warp::cosine_power((u, v), exponent)) {
                assert!((w.length() - 1.0).abs() < 1e-6 && w.z >= 0.0, "({u}, {v}): {w}");
            }
            assert!((warp::cosine_hemisphere((u, v)).length() - 1.0).abs() < 1e-6);
        }
    }
}

/// The tests above can fail.
#[test]
fn wrong_densities_are_rejected() {
    // Cosine-weighted directions are not uniform over the hemisphere, for which cos θ would be uniform.
    let cosine = numbers(4).map(warp::cosine_hemisphere).map(|w| (f64::from(w.z), turn(w.x, w.y)));
    assert!(uniformity(CELLS, cosine) < 1e-12);
    // An exponent that is wrong by 10 % (2 % would not be detected with these 576 cells).
    let lobe =
        numbers(5).map(|u| warp::cosine_power(u, 50.0)).map(|w| (f64::from(w.z).powf(56.0), turn(w.x, w.y)));
    assert!(uniformity(CELLS, lobe) < ALPHA);
    // The square's lower half as a triangle, without folding: correct support, wrong density.
    let triangle = numbers(6).map(|(u, v)| (f64::from(u), f64::from(u * v)));
    let points = triangle.map(|(b, c)| (b.powi(2), if b > 0.0 { c / b } else { 0.0 }));
    assert!(uniformity(CELLS, points) < 1e-12);
}
