//! BSDF samples agree with the density of the BSDF.
//!
//! For every material, viewer and shading normal below: a χ² test of samples in bins around the mirror direction
//! against the integral of `pdf` over each bin. `None` and delta samples have bins of their own, so that the frequency of
//! `None` is tested against 1 − ∫ pdf − (probability of delta samples).
//!
//! 88 tests at 1e-6 each: a correct program fails with a probability below 1e-4 (seeds are fixed). With 150,000
//! samples in 258 bins, a density that is wrong by 3 % (root mean square over the bins) is detected.

mod common;

use arty::math::{Rgb, Vec3};
use arty::sampler::Sampler;
use arty::scene::{Material, Specular};
use common::quadrature::{Polar, over_ring};
use common::scenes::{Surface, diffuse, mirror, phong, plate, surface, tilted};
use common::statistics::chi_squared;

const ALPHA: f64 = 1e-6;
const SAMPLES: u64 = 150_000;
const RINGS: usize = 16;
const SECTORS: usize = 16;
/// Midpoints per side of each bin.
const STEPS: usize = 24;

fn materials() -> Vec<(&'static str, Material)> {
    let mixed = |exponent, kd, ks| Material { diffuse: Rgb::gray(kd), ..phong(ks, exponent) };
    vec![
        ("diffuse", diffuse(0.7)),
        ("phong 0", phong(0.8, 0.0)),
        ("phong 1", phong(0.8, 1.0)),
        ("phong 20", phong(0.8, 20.0)),
        ("phong 1000", phong(0.8, 1e3)),
        ("phong 100000", phong(0.8, 1e5)),
        ("diffuse + phong 20", mixed(20.0, 0.5, 0.3)),
        ("diffuse + phong 1000", mixed(1e3, 0.2, 0.6)),
        ("diffuse + phong 1000, rarely picked", mixed(1e3, 0.9, 0.01)),
        ("diffuse + mirror", Material { diffuse: Rgb::new(0.1, 0.4, 0.9), ..mirror(0.5) }),
        (
            "coloured",
            Material {
                diffuse: Rgb::new(0.9, 0.0, 0.1),
                specular: Specular::Phong { reflectance: Rgb::new(0.0, 0.3, 0.8), exponent: 5.0 },
                ..diffuse(0.0)
            },
        ),
    ]
}

/// The expected frequency of each bin, by quadrature, and the numbers of samples.
struct Comparison {
    expected: Vec<f64>,
    observed: Vec<u64>,
}

impl Comparison {
    /// `density` is the density under test: the BSDF's `pdf`, except in tests of the test.
    fn new(it: &Surface, seed: u64, density: impl Fn(Vec3) -> f64) -> Self {
        let (normal, wo) = (it.normal.as_dvec3(), it.wo.as_dvec3());
        let polar = Polar::around(2.0 * normal.dot(wo) * normal - wo);
        let rings = ring_bounds(it, &polar);

        let mut expected: Vec<f64> = Vec::with_capacity(RINGS * SECTORS + 2);
        for ring in rings.windows(2) {
            for sector in 0..SECTORS {
                let turns = (sector as f64 / SECTORS as f64, (sector + 1) as f64 / SECTORS as f64);
                expected.push(over_ring(&polar, (ring[0], ring[1]), turns, STEPS, &density));
            }
        }
        let smooth: f64 = expected.iter().sum();

        let mut sampler = Sampler::new(seed, (0, 0), 0);
        let mut observed = vec![0; RINGS * SECTORS + 2];
        let mut delta_probability = 0.0;
        for _ in 0..SAMPLES {
            let bin = match it.bsdf.sample(&mut sampler) {
                None => RINGS * SECTORS,
                Some(sample) if sample.is_delta => {
                    delta_probability = f64::from(sample.pdf);
                    RINGS * SECTORS + 1
                }
                Some(sample) => {
                    let (t, turn) = polar.coordinates(sample.wi);
                    let ring = rings[1..RINGS].partition_point(|bound| *bound <= t);
                    ring * SECTORS + ((turn * SECTORS as f64) as usize).min(SECTORS - 1)
                }
            };
            observed[bin] += 1;
        }
        let nothing = 1.0 - smooth - delta_probability;
        // Up to the quadrature error; a larger integral would not be a density.
        assert!(nothing > -1e-3, "the density integrates to {}", 1.0 - nothing);
        expected.extend([nothing.max(0.0), delta_probability]);
        Self { expected: expected.into_iter().map(|share| share * SAMPLES as f64).collect(), observed }
    }

    fn p_value(&self) -> f64 {
        chi_squared(&self.observed, &self.expected)
    }
}

/// Bounds of 1 − cos α between which samples are about equally frequent, from samples with another seed.
fn ring_bounds(it: &Surface, polar: &Polar) -> Vec<f64> {
    let mut sampler = Sampler::new(999, (0, 0), 0);
    let mut ts: Vec<f64> = (0..4000)
        .filter_map(|_| it.bsdf.sample(&mut sampler))
        .filter(|sample| !sample.is_delta)
        .map(|sample| polar.coordinates(sample.wi).0)
        .collect();
    ts.sort_unstable_by(f64::total_cmp);
    let mut bounds: Vec<f64> = (0..=RINGS).map(|i| ts[i * (ts.len() - 1) / RINGS]).collect();
    (bounds[0], bounds[RINGS]) = (0.0, 2.0);
    bounds
}

fn viewers() -> [Vec3; 4] {
    [0.0, 45.0, 85.0, 89.5].map(|theta| tilted(theta, 0.3))
}

fn samples_follow_the_density(shading_normal: Option<Vec3>) {
    for (number, (name, material)) in materials().into_iter().enumerate() {
        let plate = plate(material, shading_normal);
        for (view, wo) in viewers().into_iter().enumerate() {
            let it = surface(&plate, wo);
            if shading_normal.is_some() {
                assert!(it.normal != it.geometric_normal);
            }
            let p =
                Comparison::new(&it, (8 * number + view) as u64, |wi| f64::from(it.bsdf.pdf(wi))).p_value();
            assert!(p > ALPHA, "{name}, wo = {wo}: p = {p}");
        }
    }
}

#[test]
fn samples_agree_with_the_density_for_flat_shading() {
    samples_follow_the_density(None);
}

#[test]
fn samples_agree_with_the_density_for_tilted_shading_normals() {
    samples_follow_the_density(Some(tilted(25.0, 1.3)));
}

#[test]
fn no_sample_is_lost_if_the_whole_lobe_is_above_the_horizon() {
    for (material, theta) in [(diffuse(0.5), 70.0), (phong(0.5, 1000.0), 0.0), (phong(0.5, 1e5), 80.0)] {
        let plate = plate(material, None);
        let it = surface(&plate, tilted(theta, 0.3));
        let mut sampler = Sampler::new(77, (0, 0), 0);
        // One in 10⁷ diffuse directions is rounded down to the horizon.
        assert!((0..100_000).all(|_| it.bsdf.sample(&mut sampler).is_some()));
    }
}

/// The tests above can fail.
#[test]
fn wrong_densities_are_rejected() {
    let cosine = plate(diffuse(0.5), None);
    let it = surface(&cosine, tilted(45.0, 0.3));
    let uniform = |wi: Vec3| if wi.z > 0.0 { std::f64::consts::TAU.recip() } else { 0.0 };
    assert!(Comparison::new(&it, 1, uniform).p_value() < 1e-12, "uniform instead of cosine");

    let mixture = plate(Material { diffuse: Rgb::gray(0.5), ..phong(0.3, 20.0) }, None);
    let it = surface(&mixture, tilted(85.0, 0.3));
    let lobes = [diffuse(0.5), phong(0.3, 20.0)].map(|material| surface(&plate(material, None), it.wo).bsdf);
    let pdf = |share: f64, wi: Vec3| {
        share * f64::from(lobes[0].pdf(wi)) + (1.0 - share) * f64::from(lobes[1].pdf(wi))
    };
    assert!(Comparison::new(&it, 2, |wi| pdf(0.625, wi)).p_value() > ALPHA, "kd / (kd + ks)");
    assert!(
        Comparison::new(&it, 2, |wi| pdf(0.60, wi)).p_value() < ALPHA,
        "lobes picked with another probability"
    );
    // The part of a lobe below the horizon, distributed over the rest: 14 % too much.
    let lobe = surface(&plate(phong(0.3, 20.0), None), tilted(70.0, 0.3));
    let kept = Comparison::new(&lobe, 3, |wi| f64::from(lobe.bsdf.pdf(wi)));
    let share = kept.expected[..RINGS * SECTORS].iter().sum::<f64>() / SAMPLES as f64;
    assert!(share < 0.95, "{share}");
    let renormalised = Comparison::new(&lobe, 3, |wi| f64::from(lobe.bsdf.pdf(wi)) / share);
    assert!(renormalised.p_value() < 1e-12);
}
