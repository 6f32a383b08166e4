//! Values of BSDFs: consistency of samples, reciprocity, energy conservation, documented properties.
//!
//! Statistical tests: 36 estimates of the albedo at 1e-6 each; a correct program fails with a probability below 4e-5.

mod common;

use std::f64::consts::PI;

use arty::math::{Rgb, Vec3};
use arty::sampler::Sampler;
use arty::scene::{Material, Specular};
use common::quadrature::{Polar, over_sphere, spiral};
use common::scenes::{Surface, black, diffuse, glass, mirror, phong, plate, surface, tilted};
use common::statistics::Estimate;

const ALPHA: f64 = 1e-6;

fn mixed(kd: f32, ks: f32, exponent: f32) -> Material {
    Material { diffuse: Rgb::gray(kd), ..phong(ks, exponent) }
}

fn all_materials() -> Vec<Material> {
    let mut materials: Vec<Material> =
        [0.0, 1.0, 20.0, 1e3, 1e5, 1e6, 1e9].map(|exponent| phong(0.5, exponent)).to_vec();
    materials.extend([
        diffuse(0.5),
        mixed(0.5, 0.4, 1.0),
        mixed(0.5, 0.4, 1e6),
        mirror(0.9),
        Material { diffuse: Rgb::gray(0.3), ..mirror(0.6) },
        glass(1.5),
        glass(1.0),
        Material { diffuse: Rgb::gray(0.3), ..glass(1.5) },
    ]);
    materials
}

fn all_viewers() -> Vec<Vec3> {
    [0.0, 30.0, 70.0, 85.0, 89.5, 89.99, 89.9999].map(|theta| tilted(theta, 0.3)).to_vec()
}

fn all_normals() -> [Option<Vec3>; 3] {
    [None, Some(tilted(15.0, 1.4)), Some(tilted(60.0, 0.5))]
}

fn albedo(it: &Surface, steps: usize) -> f64 {
    let (normal, wo) = (it.normal.as_dvec3(), it.wo.as_dvec3());
    let polar = Polar::around(2.0 * normal.dot(wo) * normal - wo);
    over_sphere(&polar, steps, &|wi| f64::from(it.bsdf.eval(wi).g) * wi.as_dvec3().dot(normal).abs())
}

#[test]
fn samples_agree_with_eval_and_pdf_and_have_the_documented_properties() {
    let mut seen = 0;
    for material in all_materials() {
        for normal in all_normals() {
            let plate = plate(material.clone(), normal);
            for wo in all_viewers() {
                let it = surface(&plate, wo);
                let mut sampler = Sampler::new(1, (2, 3), 4);
                for sample in (0..300).filter_map(|_| it.bsdf.sample(&mut sampler)) {
                    seen += 1;
                    let context = || format!("{material:?}, wo = {wo}: {sample:?}");
                    assert!((sample.wi.length() - 1.0).abs() < 1e-6, "{}", context());
                    assert!(sample.f.is_finite() && sample.f.min_channel() >= 0.0, "{}", context());
                    assert!(sample.pdf.is_finite() && sample.pdf > 0.0, "{}", context());
                    assert_eq!(sample.cos, it.normal.dot(sample.wi).abs(), "{}", context());
                    // f · cos / pdf is bounded by (n + 2) / (n + 1) times the reflectance, the squared index ratio, or the
                    // reciprocal of the minimum selection probability of a lobe.
                    let weight = sample.f * (sample.cos / sample.pdf);
                    assert!(weight.is_finite() && weight.max_channel() < 20.0, "{}", context());
                    if sample.is_delta {
                        assert!(sample.pdf <= 1.0, "{}", context());
                    } else {
                        assert_eq!(sample.f, it.bsdf.eval(sample.wi), "{}", context());
                        assert_eq!(sample.pdf, it.bsdf.pdf(sample.wi), "{}", context());
                        let above =
                            it.geometric_normal.dot(sample.wi) > 0.0 && it.normal.dot(sample.wi) > 0.0;
                        assert!(above, "{}", context());
                    }
                }
            }
        }
    }
    assert!(seen > 15 * 3 * 7 * 100, "{seen}");
}

#[test]
fn eval_and_pdf_are_zero_below_either_horizon_and_for_delta_lobes() {
    for material in all_materials() {
        for normal in all_normals() {
            let plate = plate(material.clone(), normal);
            let it = surface(&plate, tilted(40.0, 0.3));
            for (wi, _) in spiral(2000) {
                let (f, pdf) = (it.bsdf.eval(wi), it.bsdf.pdf(wi));
                let below = it.normal.dot(wi) <= 0.0 || it.geometric_normal.dot(wi) <= 0.0;
                if below || it.bsdf.is_delta() {
                    assert!(f.is_black() && pdf == 0.0, "{material:?}, wi = {wi}: {f:?}, {pdf}");
                } else {
                    assert!(f.is_finite() && f.min_channel() >= 0.0 && pdf.is_finite() && pdf >= 0.0);
                    assert!(f.is_black() == (pdf == 0.0), "{material:?}, wi = {wi}: {f:?}, {pdf}");
                }
            }
        }
    }
}

#[test]
fn is_delta_is_true_for_purely_specular_materials_only() {
    let is_delta = |material| surface(&plate(material, None), tilted(40.0, 0.3)).bsdf.is_delta();
    assert!(is_delta(mirror(0.5)) && is_delta(glass(1.5)));
    assert!(!is_delta(diffuse(0.5)) && !is_delta(phong(0.5, 1e9)) && !is_delta(mixed(0.5, 0.5, 5.0)));
    assert!(!is_delta(Material { diffuse: Rgb::gray(0.1), ..mirror(0.5) }));
    assert!(!is_delta(mirror(0.0)), "a mirror that reflects nothing is a black surface");
}

#[test]
fn black_materials_are_never_sampled() {
    let mut sampler = Sampler::new(5, (0, 0), 0);
    for material in [black(), phong(0.0, 20.0), mirror(0.0)] {
        let it = surface(&plate(material, None), tilted(40.0, 0.3));
        assert!((0..1000).all(|_| it.bsdf.sample(&mut sampler).is_none()));
    }
    // A black second lobe wastes no samples.
    for specular in [
        Specular::Phong { reflectance: Rgb::BLACK, exponent: 20.0 },
        Specular::Mirror { reflectance: Rgb::BLACK },
    ] {
        let it = surface(&plate(Material { specular, ..diffuse(0.5) }, None), tilted(40.0, 0.3));
        for sample in (0..1000).map(|_| it.bsdf.sample(&mut sampler)) {
            let sample = sample.expect("the diffuse lobe lies above the horizon");
            assert!((sample.pdf * std::f32::consts::PI - sample.cos).abs() < 1e-6, "{sample:?}");
        }
    }
}

#[test]
fn reflection_is_reciprocal() {
    for (material, tolerance) in [
        (diffuse(0.5), 1e-6),
        (phong(0.5, 1.0), 1e-5),
        (phong(0.5, 20.0), 1e-5),
        // The error of cosⁿ near an angle of n^-1/2: a rounding of 1e-7 grows with the square root of n.
        (phong(0.5, 1e3), 1e-4),
        (phong(0.5, 1e5), 1e-3),
        (mixed(0.3, 0.5, 100.0), 1e-4),
    ] {
        let plate = plate(material.clone(), None);
        let mut compared = 0;
        for wo in all_viewers() {
            let there = surface(&plate, wo);
            let mut sampler = Sampler::new(6, (0, 0), 0);
            // Sampled from the lobe, so that narrow lobes are covered.
            for sample in (0..200).filter_map(|_| there.bsdf.sample(&mut sampler)) {
                // Near grazing angles rounding changes the result.
                if sample.wi.z < 1e-3 {
                    continue;
                }
                compared += 1;
                let back = surface(&plate, sample.wi).bsdf.eval(wo).g;
                let error = (back / sample.f.g - 1.0).abs();
                assert!(error < tolerance, "{material:?}, {wo} and {}: {} and {back}", sample.wi, sample.f.g);
            }
        }
        assert!(compared > 300, "{material:?}: {compared}");
    }
}

#[test]
fn all_materials_conserve_energy() {
    for material in [0.0, 0.5, 1.0, 5.0, 20.0, 1e3, 1e5].map(|exponent| phong(1.0, exponent)) {
        for normal in all_normals() {
            let plate = plate(material.clone(), normal);
            for theta in (0..=89).step_by(11) {
                let albedo = albedo(&surface(&plate, tilted(theta as f32, 0.3)), 64);
                // The quadrature error at the horizon is a few parts in 10⁴.
                assert!((0.0..1.0 + 1e-3).contains(&albedo), "{material:?}, {normal:?}, {theta}°: {albedo}");
            }
        }
    }
}

#[test]
fn albedos_agree_with_closed_forms() {
    // Diffuse: ρ, from all directions.
    for theta in [0.0, 45.0, 85.0] {
        let it = surface(&plate(diffuse(0.6), None), tilted(theta, 0.3));
        assert!((albedo(&it, 128) - 0.6).abs() < 1e-3);
    }
    // Phong: ks at normal incidence, for all exponents.
    for exponent in [0.0, 1.0, 20.0, 1e3, 1e5, 1e6] {
        let it = surface(&plate(phong(0.6, exponent), None), Vec3::Z);
        let albedo = albedo(&it, 128);
        assert!((albedo / 0.6 - 1.0).abs() < 5e-4, "exponent {exponent}: {albedo}");
    }
    // Phong, n = 1, at the angle θ: ks 3/2π ∫ max(0, wi·r) wi·n over the hemisphere. The integral of the product of
    // two clamped cosines an angle θ apart is 2/3 (sin θ + (π − θ) cos θ) (spherical convolution of cosines).
    for theta in [0.0f64, 30.0, 60.0, 85.0] {
        let it = surface(&plate(phong(1.0, 1.0), None), tilted(theta as f32, 0.3));
        let angle = theta.to_radians();
        let exact = 1.5 / PI * 2.0 / 3.0 * (angle.sin() + (PI - angle) * angle.cos());
        let albedo = albedo(&it, 192);
        assert!((albedo / exact - 1.0).abs() < 1e-3, "{theta}°: {albedo}, expected {exact}");
    }
}

#[test]
fn the_mean_weight_of_samples_is_the_albedo() {
    for (number, material) in [
        diffuse(0.8),
        phong(0.8, 0.0),
        phong(0.8, 20.0),
        phong(0.8, 1e3),
        mixed(0.3, 0.6, 50.0),
        mixed(0.7, 0.05, 1e3),
    ]
    .into_iter()
    .enumerate()
    {
        for normal in [None, Some(tilted(25.0, 1.3))] {
            let plate = plate(material.clone(), normal);
            for theta in [0.0, 45.0, 85.0] {
                let it = surface(&plate, tilted(theta, 0.3));
                let mut sampler = Sampler::new(7, (number as u32, theta as u32), 0);
                let weights = (0..100_000).map(|_| {
                    it.bsdf
                        .sample(&mut sampler)
                        .map_or(0.0, |sample| f64::from(sample.f.g * sample.cos / sample.pdf))
                });
                // The quadrature error at the horizon counts as rounding.
                let what = format!("{material:?}, {normal:?}, {theta}°");
                let weights = Estimate::of(weights);
                weights.assert_is(albedo(&it, 128), 2e-3, 0.03, ALPHA, &what);
            }
        }
    }
}

#[test]
fn mirrors_reflect_their_reflectance_in_the_mirror_direction() {
    for theta in [0.0, 45.0, 85.0, 89.5] {
        let wo = tilted(theta, 0.3);
        let it = surface(&plate(mirror(0.7), None), wo);
        let sample = it.bsdf.sample(&mut Sampler::new(8, (0, 0), 0)).expect("a mirror reflects");
        assert!((sample.wi - Vec3::new(-wo.x, -wo.y, wo.z)).length() < 1e-6);
        assert!(sample.is_delta && sample.pdf == 1.0);
        assert!((sample.f.g * sample.cos / sample.pdf - 0.7).abs() < 1e-6);
    }
}
