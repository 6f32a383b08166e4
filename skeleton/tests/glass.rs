//! Glass obeys the laws of Fresnel and Snell, in double precision and their textbook forms.
//!
//! Statistical tests: 17 frequencies at 1e-6 each; a correct program fails with a probability below 2e-5.

mod common;

use arty::bsdf::BsdfSample;
use arty::math::{Rgb, Vec3};
use arty::sampler::Sampler;
use arty::scene::{Material, Specular};
use common::scenes::{black, glass, plate, surface, tilted};
use common::statistics::share;

const ALPHA: f64 = 1e-6;
const SAMPLES: u64 = 20_000;

/// Angle of refraction and reflectance for unpolarized light from a medium of index `n1` into one of index `n2` (Hecht, "Optics", 4.6: r⊥ = −sin(θi − θt) / sin(θi + θt), r∥ = tan(θi − θt) / tan(θi + θt)).
fn fresnel(theta: f64, n1: f64, n2: f64) -> Option<(f64, f64)> {
    let sin_t = n1 / n2 * theta.sin();
    if sin_t >= 1.0 {
        return None;
    }
    let theta_t = sin_t.asin();
    if theta == 0.0 {
        return Some((0.0, ((n1 - n2) / (n1 + n2)).powi(2)));
    }
    let (difference, sum) = (theta - theta_t, theta + theta_t);
    let (rs, rp) = (difference.sin() / sum.sin(), difference.tan() / sum.tan());
    Some((theta_t, 0.5 * (rs * rs + rp * rp)))
}

/// Samples at the angle `theta` (degrees) from outside or inside: (reflected, refracted).
fn sample(index: f32, theta: f32, outside: bool) -> (Vec<BsdfSample>, Vec<BsdfSample>) {
    let side = if outside { Vec3::ONE } else { Vec3::new(1.0, 1.0, -1.0) };
    let it = surface(&plate(glass(index), None), side * tilted(theta, 0.3));
    let mut sampler = Sampler::new(1, (theta as u32, u32::from(outside)), index.to_bits().into());
    (0..SAMPLES)
        .map(|_| it.bsdf.sample(&mut sampler).expect("clear glass loses nothing"))
        .partition(|sample| sample.wi.dot(it.wo * Vec3::Z) > 0.0)
}

fn weight(sample: &BsdfSample) -> f64 {
    f64::from(sample.f.g) * f64::from(sample.cos) / f64::from(sample.pdf)
}

#[test]
fn reflectance_obeys_fresnels_law_and_refraction_snells() {
    for index in [1.33, 1.5] {
        for theta in [0.0, 20.0, 40.0, 60.0, 80.0] {
            for outside in [true, false] {
                let n = f64::from(index);
                let (n1, n2) = if outside { (1.0, n) } else { (n, 1.0) };
                let angle = f64::from(theta).to_radians();
                let (reflected, refracted) = sample(index, theta, outside);
                let context = format!("index {index}, {theta}°, from outside: {outside}");
                for sample in reflected.iter().chain(&refracted) {
                    assert!(sample.is_delta && (sample.wi.length() - 1.0).abs() < 1e-6, "{context}");
                }
                for sample in &reflected {
                    assert!((weight(sample) - 1.0).abs() < 1e-5, "{context}: {sample:?}");
                    assert!(
                        (f64::from(sample.wi.z.abs()) - angle.cos()).abs() < 1e-6,
                        "{context}: {sample:?}"
                    );
                }
                let Some((angle_t, reflectance)) = fresnel(angle, n1, n2) else {
                    assert!(refracted.is_empty(), "{context}: total internal reflection");
                    continue;
                };
                let p = share(reflected.len() as u64, SAMPLES, reflectance);
                assert!(
                    p > ALPHA,
                    "{context}: {} of {SAMPLES} reflected, expected {reflectance}",
                    reflected.len()
                );
                for sample in &refracted {
                    let wi = sample.wi.as_dvec3();
                    assert!((wi.truncate().length() - angle_t.sin()).abs() < 1e-6, "{context}: Snell, {wi}");
                    // In the plane of incidence: opposite to the viewer's azimuth.
                    if theta > 0.0 {
                        let azimuth = wi.y.atan2(wi.x) + std::f64::consts::PI;
                        assert!((azimuth - 0.3).abs() < 1e-5, "{context}: {azimuth}");
                    }
                    // Radiance changes with the squared index: L_o = L_i (n_o / n_i)².
                    let expected = (n1 / n2).powi(2);
                    assert!((weight(sample) / expected - 1.0).abs() < 1e-5, "{context}: {sample:?}");
                    assert!(
                        (f64::from(sample.pdf) - (1.0 - reflectance)).abs() < 1e-5,
                        "{context}: {sample:?}"
                    );
                }
                // In terms of L / n², reflection and transmission sum to 1.
                let pdf =
                    |samples: &[BsdfSample]| samples.first().map_or(0.0, |sample| f64::from(sample.pdf));
                assert!((pdf(&reflected) + pdf(&refracted) - 1.0).abs() < 1e-5, "{context}");
            }
        }
    }
}

#[test]
fn the_sine_of_the_critical_angle_is_one_over_the_index() {
    let critical = (1.0f32 / 1.5).asin().to_degrees();
    assert!(!sample(1.5, critical - 0.1, false).1.is_empty());
    assert!(sample(1.5, critical + 0.1, false).1.is_empty());
}

#[test]
fn transmission_is_reciprocal() {
    // Reciprocity of transmission: f(wo, wi) / n_i² = f(wi, wo) / n_o² (Veach 1997, 5.2). For delta lobes: the transmittances
    // in both directions are equal, so that the squared index ratios of the weights cancel.
    for theta in [5.0, 30.0, 60.0, 85.0] {
        let there = sample(1.5, theta, true).1[0];
        let angle_t = (f64::from(theta).to_radians().sin() / 1.5).asin().to_degrees();
        let back = sample(1.5, angle_t as f32, false).1[0];
        assert!((there.pdf - back.pdf).abs() < 2e-5, "{theta}°: {} and {}", there.pdf, back.pdf);
        assert!((weight(&there) * weight(&back) - 1.0).abs() < 1e-5);
    }
}

#[test]
fn radiance_inside_glass_is_scaled_by_the_squared_index() {
    let (reflected, refracted) = sample(1.5, 0.0, false);
    assert!((weight(&refracted[0]) - 2.25).abs() < 1e-4 && (weight(&reflected[0]) - 1.0).abs() < 1e-5);
}

#[test]
fn equal_indices_have_no_effect() {
    for outside in [true, false] {
        let (reflected, refracted) = sample(1.0, 70.0, outside);
        assert!(reflected.is_empty());
        assert!(refracted.iter().all(|sample| (weight(sample) - 1.0).abs() < 1e-6));
    }
}

#[test]
fn reflectance_and_transmittance_are_coloured_by_their_factors() {
    let (reflectance, transmittance) = (Rgb::new(0.1, 0.2, 0.3), Rgb::new(0.9, 0.8, 0.7));
    let material =
        Material { specular: Specular::Glass { index: 1.5, reflectance, transmittance }, ..black() };
    let it = surface(&plate(material, None), tilted(60.0, 0.3));
    let mut sampler = Sampler::new(3, (0, 0), 0);
    let (mut reflected, mut refracted) = (0, 0);
    for sample in (0..1000).filter_map(|_| it.bsdf.sample(&mut sampler)) {
        let weight = sample.f * (sample.cos / sample.pdf);
        let expected = if sample.wi.z > 0.0 { reflectance } else { transmittance / 2.25 };
        *if sample.wi.z > 0.0 { &mut reflected } else { &mut refracted } += 1;
        assert!((weight - expected).map(f32::abs).max_channel() < 1e-5, "{weight:?}, expected {expected:?}");
    }
    assert!(reflected > 0 && refracted > 0);
}

/// The tests above can fail.
#[test]
fn a_wrong_reflectance_is_rejected() {
    let (reflected, _) = sample(1.5, 60.0, true);
    let (_, exact) = fresnel(60f64.to_radians(), 1.0, 1.5).expect("light enters the denser side");
    assert!(share(reflected.len() as u64, SAMPLES, exact) > ALPHA);
    // Schlick's approximation: 6.7 % instead of 8.9 %.
    let schlick = 0.04 + 0.96 * 0.5f64.powi(5);
    assert!(share(reflected.len() as u64, SAMPLES, schlick) < ALPHA);
}
