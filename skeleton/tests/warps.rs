//! Maps from random numbers to directions, against their densities.
//!
//! Each map is inverted: if it has the density that it claims, the distribution function of what it gives is uniform.
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
fn the_disk_is_covered_evenly() {
    let points = numbers(1).map(warp::disk).map(|p| (p.as_dvec2().length_squared(), turn(p.x, p.y)));
    let p = uniformity(CELLS, points);
    assert!(p > ALPHA, "{p}");
}

#[test]
fn the_hemisphere_is_covered_in_proportion_to_the_cosine() {
    // ∫ cos θ / π dω up to θ is sin² θ.
    let points = numbers(2).map(warp::cosine_hemisphere).map(|w| {
        assert!(w.z > 0.0 && (w.length() - 1.0).abs() < 1e-6, "{w}");
        (1.0 - f64::from(w.z).powi(2), turn(w.x, w.y))
    });
    let p = uniformity(CELLS, points);
    assert!(p > ALPHA, "{p}");
}

#[test]
fn lobes_follow_the_power_of_the_cosine() {
    let polar = Polar::around(glam::DVec3::Z);
    for (seed, exponent) in [(10, 0.0), (11, 1.0), (12, 10.0), (13, 1e3), (14, 1e6), (15, 1e9)] {
        // ∫ (n + 1) / 2π cosⁿ α dω from α on is cosⁿ⁺¹ α.
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
fn triangles_are_covered_evenly() {
    let points = numbers(3).map(warp::triangle).map(|[b, c]| {
        assert!(b >= 0.0 && c >= 0.0 && b + c <= 1.0, "{b} {c}");
        let (b, c) = (f64::from(b), f64::from(c));
        // The sum grows with the square root of the area below it, and divides evenly into b and c.
        ((b + c).powi(2), if b + c > 0.0 { c / (b + c) } else { 0.0 })
    });
    let p = uniformity(CELLS, points);
    assert!(p > ALPHA, "{p}");
}

#[test]
fn densities_of_directions_integrate_to_one() {
    // 1 − cos α up to the horizon, where the densities end, that of exponent 0 with a jump.
    const HEMISPHERE: (f64, f64) = (0.0, 1.0);
    let polar = Polar::around(glam::DVec3::Z);
    let cosine =
        over_ring(&polar, HEMISPHERE, (0.0, 1.0), 256, &|w| f64::from(warp::cosine_hemisphere_pdf(w.z)));
    assert!((cosine - 1.0).abs() < 1e-4, "{cosine}");
    for exponent in [0.0, 1.0, 10.0, 1e3, 1e6] {
        let lobe = over_ring(&polar, HEMISPHERE, (0.0, 1.0), 128, &|w| {
            f64::from(warp::cosine_power_pdf(warp::power_of_cosine(Vec3::Z, w, exponent), exponent))
        });
        // A rounding of a direction is an angle of 6e-8 rad; in the lobe of 1e6 that is 1e-4 of its width.
        assert!((lobe - 1.0).abs() < 5e-4, "exponent {exponent}: {lobe}");
    }
}

#[test]
fn the_corners_of_the_unit_square_give_directions_too() {
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

/// The tests above must be able to fail.
#[test]
fn wrong_densities_are_rejected() {
    // Directions with the density of the cosine are not uniform over the hemisphere, where cos θ would be uniform.
    let cosine = numbers(4).map(warp::cosine_hemisphere).map(|w| (f64::from(w.z), turn(w.x, w.y)));
    assert!(uniformity(CELLS, cosine) < 1e-12);
    // An exponent that is wrong by a tenth (one by a fiftieth would escape these 576 cells).
    let lobe =
        numbers(5).map(|u| warp::cosine_power(u, 50.0)).map(|w| (f64::from(w.z).powf(56.0), turn(w.x, w.y)));
    assert!(uniformity(CELLS, lobe) < ALPHA);
    // The square's lower half as a triangle, without folding: right support, wrong density.
    let triangle = numbers(6).map(|(u, v)| (f64::from(u), f64::from(u * v)));
    let points = triangle.map(|(b, c)| (b.powi(2), if b > 0.0 { c / b } else { 0.0 }));
    assert!(uniformity(CELLS, points) < 1e-12);
}
