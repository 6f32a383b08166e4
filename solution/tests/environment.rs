//! The solution of exercise 6 agrees with closed forms: its density with the map, its samples with its density, the path
//! tracer with integrals that are known.
//!
//! Statistical tests have fixed seeds and false-alarm rates of 1e-6 each, about 60 in all: a correct program fails with a
//! probability below 1e-4. Tests of means also assert their resolution, the bias that they detect with a probability of one half.

#[path = "../../skeleton/tests/common/mod.rs"]
mod common;
#[path = "../../assignments/06-environment/solution.rs"]
pub mod environment;

use std::f64::consts::{PI, TAU};

use arty::environment::{DirectionSample, Environment, SampleDirections};
use arty::math::{Rgb, Vec3};
use arty::prelude::{Integrator, Sampler, Settings, Technique};
use arty::render::sample_pixel;
use arty::sampler::Streams;
use arty::scene::{EnvironmentDescription, LightDescription, Scene, SceneDescription};
use common::scenes::{add, add_lights, diffuse, empty, glass, icosphere, mirror, phong, quad};
use common::statistics::{Estimate, chi_squared, uniformity};
use environment::{EnvironmentSampler, PathTracer};
use glam::Quat;

const ALPHA: f64 = 1e-6;

/// A map from a function of the direction at the centre of each texel.
fn map_of(width: u32, height: u32, radiance: impl Fn(u32, u32) -> Rgb) -> EnvironmentDescription {
    let texels = (0..height).flat_map(|row| (0..width).map(move |column| (column, row)));
    let texels = texels.map(|(column, row)| radiance(column, row)).collect();
    EnvironmentDescription { width, height, texels, rotation: Quat::IDENTITY }
}

fn built(map: &EnvironmentDescription) -> Environment {
    Environment::new(map.width as usize, map.height as usize, map.texels.clone(), map.rotation)
}

fn hash(column: u32, row: u32) -> f32 {
    let mixed =
        ((column + 1).wrapping_mul(0x9e37_79b9) ^ row.wrapping_mul(0x85eb_ca6b)).wrapping_mul(0xc2b2_ae35);
    (mixed >> 8) as f32 / 16_777_216.0
}

/// Texels of very different radiance, some black.
fn rough(width: u32, height: u32) -> EnvironmentDescription {
    map_of(width, height, |column, row| {
        let random = hash(column, row);
        let value = if random < 0.2 { 0.0 } else { (8.0 * random).exp() };
        Rgb::new(value, 0.5 * value, hash(row, column) * value)
    })
}

/// The solid angle of a texel of a row.
fn solid_angle(map: &EnvironmentDescription, row: u32) -> f64 {
    let at = |row: u32| (PI * f64::from(row) / f64::from(map.height)).cos();
    (at(row) - at(row + 1)) * TAU / f64::from(map.width)
}

/// The probability of each texel, by the definition of the sheet.
fn probabilities(map: &EnvironmentDescription) -> Vec<f64> {
    let weight = |(index, texel): (usize, &Rgb)| {
        f64::from(texel.luminance()) * solid_angle(map, index as u32 / map.width)
    };
    let weights: Vec<f64> = map.texels.iter().enumerate().map(weight).collect();
    let total: f64 = weights.iter().sum();
    weights.iter().map(|weight| weight / total).collect()
}

fn maps() -> Vec<(&'static str, EnvironmentDescription)> {
    let turned = Quat::from_axis_angle(Vec3::new(0.48, -0.6, 0.64), 2.3);
    vec![
        ("1 x 1", rough(1, 1)),
        ("constant", map_of(12, 6, |_, _| Rgb::gray(0.5))),
        ("odd", rough(13, 7)),
        ("one row", rough(9, 1)),
        ("one column", rough(1, 9)),
        ("turned", EnvironmentDescription { rotation: turned, ..rough(32, 16) }),
        ("poles only", map_of(4, 8, |_, row| Rgb::gray(if row == 0 || row == 7 { 1.0 } else { 0.0 }))),
        (
            "seam only",
            map_of(8, 4, |column, _| Rgb::gray(if column == 0 || column == 7 { 1.0 } else { 0.0 })),
        ),
        (
            "one bright texel",
            map_of(1024, 1024, |column, row| Rgb::gray(if (column, row) == (1023, 300) { 1e6 } else { 1.0 })),
        ),
    ]
}

fn samples(environment: &Environment, count: u64) -> (EnvironmentSampler, Vec<DirectionSample>) {
    let tables = EnvironmentSampler::new(environment);
    let sample = |index| tables.sample(environment, &mut Sampler::new(6, (0, 0), index));
    let found = (0..count).filter_map(sample).collect();
    (tables, found)
}

#[test]
fn samples_select_each_texel_with_its_probability_and_are_uniform_within() {
    for (name, map) in maps() {
        let environment = built(&map);
        let (_, samples) = samples(&environment, 200_000);
        assert!(samples.len() > 199_000, "{name}: {} samples", samples.len());
        let (mut counts, mut within) = (vec![0; map.texels.len()], Vec::new());
        for sample in &samples {
            let (u, v) = environment.uv(sample.wi);
            let (x, y) = (f64::from(u) * f64::from(map.width), f64::from(v) * f64::from(map.height));
            let (column, row) = (x as u32, (y as u32).min(map.height - 1));
            counts[(row * map.width + column) as usize] += 1;
            let cos = |row: f64| (PI * row / f64::from(map.height)).cos();
            let (top, bottom) = (cos(f64::from(row)), cos(f64::from(row + 1)));
            within.push((x - f64::from(column), ((cos(y) - top) / (bottom - top)).clamp(0.0, 1.0)));
        }
        let expected: Vec<f64> =
            probabilities(&map).iter().map(|probability| probability * samples.len() as f64).collect();
        if map.texels.len() > 1 {
            let p = chi_squared(&counts, &expected);
            assert!(p > ALPHA, "{name}: texels have a p-value of {p}");
        }
        // Where texels are not as small as the rounding of a direction.
        if map.texels.len() < 1000 {
            let p = uniformity(8, within.into_iter());
            assert!(p > ALPHA, "{name}: places within texels have a p-value of {p}");
        }
    }
}

#[test]
fn the_density_is_that_of_the_definition_and_integrates_to_one() {
    for (name, map) in maps() {
        let environment = built(&map);
        let (tables, samples) = samples(&environment, 10_000);
        let probabilities = probabilities(&map);
        let mut integral = 0.0;
        for row in 0..map.height {
            for column in 0..map.width {
                let (u, v) =
                    ((column as f32 + 0.5) / map.width as f32, (row as f32 + 0.5) / map.height as f32);
                let pdf = f64::from(tables.pdf(&environment, environment.direction(u, v)));
                let probability = probabilities[(row * map.width + column) as usize];
                let expected = probability / solid_angle(&map, row);
                assert!((pdf - expected).abs() <= 1e-5 * expected, "{name} {column} {row}: {pdf} {expected}");
                integral += pdf * solid_angle(&map, row);
            }
        }
        assert!((integral - 1.0).abs() < 1e-5, "{name}: {integral}");
        for sample in samples {
            assert_eq!(sample.pdf, tables.pdf(&environment, sample.wi), "{name}");
        }
    }
}

#[test]
fn a_black_map_has_no_samples_and_no_density() {
    let environment = built(&map_of(5, 3, |_, _| Rgb::BLACK));
    let (tables, samples) = samples(&environment, 1000);
    assert!(samples.is_empty());
    assert_eq!(tables.pdf(&environment, Vec3::Y), 0.0);
}

#[test]
fn luminance_is_estimated_without_variance() {
    let environment = built(&rough(64, 32));
    let (_, samples) = samples(&environment, 10_000);
    let of = |sample: &DirectionSample| environment.radiance(sample.wi).luminance() / sample.pdf;
    let first = of(&samples[0]);
    assert!(samples.iter().all(|sample| (of(sample) / first - 1.0).abs() < 1e-5));
}

/// The mean of the green channel over an image of 8 × 8 pixels, from batches with different seeds.
fn mean(scene: &Scene, technique: Technique, max_bounces: u32, samples: u64) -> Estimate {
    let tracer = PathTracer::new(Settings { technique, max_bounces }, scene);
    let camera = scene.camera(8, 8);
    let batch = |seed: u64| {
        let sum: f64 = (0..64)
            .flat_map(|pixel| (0..samples).map(move |sample| ((pixel % 8, pixel / 8), sample)))
            .map(|(pixel, sample)| {
                let value = sample_pixel(
                    &tracer as &dyn Integrator,
                    scene,
                    &camera,
                    Streams::independent(seed),
                    pixel,
                    sample,
                );
                assert!(value.is_finite() && value.min_channel() >= 0.0, "{pixel:?}, {sample}: {value:?}");
                f64::from(value.g)
            })
            .sum();
        sum / (64 * samples) as f64
    };
    Estimate::of((0..64).map(batch))
}

/// A camera at (0, 0, 1) that looks down at a small square in the plane z = 0, whose normal is +z.
fn facing(normal: Vec3, map: EnvironmentDescription) -> SceneDescription {
    let mut scene = empty();
    // A rotation of the whole scene: the square keeps its place in front of the camera.
    let turn = Quat::from_rotation_arc(Vec3::Z, normal);
    scene.camera.eye = normal;
    scene.camera.center = Vec3::ZERO;
    scene.camera.up = turn * Vec3::Y;
    scene.camera.fov = 1.0;
    let square: Vec<_> = quad(Vec3::new(-0.5, -0.5, 0.0), Vec3::X, Vec3::Y)
        .into_iter()
        .map(|triangle| triangle.map(|corner| turn * corner))
        .collect();
    add(&mut scene, &square, diffuse(0.8));
    scene.environment = Some(map);
    scene
}

/// The irradiance of radiance a + b·Y, where Y is a spherical harmonic of degree 0, 1 or 2, is π a + A_l b Y(normal) with
/// A = π, 2π/3, π/4 (Ramamoorthi and Hanrahan, "An Efficient Representation for Irradiance Environment Maps", 2001).
#[test]
fn the_irradiance_of_spherical_harmonics_has_their_factors() {
    type Harmonic = fn(Vec3) -> f64;
    let harmonics: [(Harmonic, f64, f64); 4] = [
        (|_| 1.0, 1.0, PI),
        (|w| f64::from(w.dot(Vec3::new(0.6, 0.0, 0.8))), 1.0, 2.0 * PI / 3.0),
        (|w| f64::from(3.0 * w.y * w.y - 1.0) / 2.0, 0.5, PI / 4.0),
        (|w| f64::from(w.x * w.z), 0.5, PI / 4.0),
    ];
    for (harmonic, offset, factor) in harmonics {
        let (width, height) = (256, 128);
        // Orientation comes from the documentation, not from `Environment`.
        let direction = |column: u32, row: u32| {
            let (azimuth, polar) = (
                TAU * ((f64::from(column) + 0.5) / f64::from(width) - 0.5),
                PI * (f64::from(row) + 0.5) / f64::from(height),
            );
            glam::DVec3::new(polar.sin() * azimuth.sin(), polar.cos(), -polar.sin() * azimuth.cos()).as_vec3()
        };
        let map = map_of(width, height, |column, row| {
            Rgb::gray((offset + harmonic(direction(column, row))).max(0.0) as f32)
        });
        for normal in [Vec3::Y, Vec3::new(0.6, 0.0, 0.8), Vec3::new(-0.48, -0.6, 0.64)] {
            let scene = Scene::new(&facing(normal, map.clone()));
            let exact = 0.8 / PI * (PI * offset + factor * harmonic(normal));
            for (technique, samples) in [(Technique::Bsdf, 60), (Technique::Nee, 60), (Technique::Mis, 60)] {
                let found = mean(&scene, technique, 1, samples);
                // Constant texels of 1.4 degrees change an irradiance by less than 2e-4.
                found.assert_is(exact, 4e-4, 2e-2, ALPHA, &format!("{technique} {normal}"));
            }
        }
    }
}

/// In a constant environment, a closed white or grey body of any shape reflects what it would reflect in a furnace: with
/// an albedo r and convex shape, each bounce either escapes or not; r per bounce for one bounce.
#[test]
fn a_convex_body_in_a_constant_environment_reflects_its_albedo() {
    let map = map_of(1, 1, |_, _| Rgb::gray(2.0));
    for (material, exact, resolution) in
        [(diffuse(0.7), 1.4, 1e-2), (mirror(0.5), 1.0, 2e-3), (glass(1.5), 2.0, 1e-2)]
    {
        let mut scene = empty();
        add(&mut scene, &icosphere(4.0 * Vec3::NEG_Z, 1.5, 3, true), material);
        scene.camera.fov = 20.0;
        scene.environment = Some(map.clone());
        let scene = Scene::new(&scene);
        for technique in Technique::ALL {
            // Light leaves glass after any number of bounces.
            mean(&scene, technique, 64, 160).assert_is(
                exact,
                1e-3,
                resolution,
                ALPHA,
                &format!("{technique}"),
            );
        }
    }
}

/// A disk of light of angular radius α around the normal: E = π L sin² α. All of the map's texels inside it are bright,
/// so the disk has the border of the map's rows and is exact.
#[test]
fn a_sphere_light_in_a_black_map_has_its_irradiance() {
    for rows in [1, 7] {
        let map = map_of(90, 45, |_, row| Rgb::gray(if row < rows { 100.0 } else { 0.0 }));
        let sin2 = (PI * f64::from(rows) / 45.0).sin().powi(2);
        let scene = Scene::new(&facing(Vec3::Y, map));
        for technique in [Technique::Nee, Technique::Mis] {
            mean(&scene, technique, 1, 20).assert_is(
                0.8 * 100.0 * sin2,
                1e-4,
                5e-2,
                ALPHA,
                &format!("{technique} {rows}"),
            );
        }
        mean(&scene, Technique::Bsdf, 1, 400).assert_is(0.8 * 100.0 * sin2, 1e-4, 0.2, ALPHA, "bsdf");
    }
}

/// All techniques agree where the environment is beside other lights, behind occluders, and in glossy reflections.
#[test]
fn techniques_agree_beside_other_lights_and_occluders() {
    let mut scene = empty();
    scene.camera.eye = Vec3::new(0.0, 1.0, 5.0);
    let floor = quad(Vec3::new(-2.0, 0.0, -2.0), 4.0 * Vec3::Z, 4.0 * Vec3::X);
    add(&mut scene, &floor, phong(0.6, 20.0));
    add(&mut scene, &icosphere(Vec3::new(0.4, 0.6, 0.0), 0.6, 2, true), diffuse(0.7));
    let light = quad(Vec3::new(-1.5, 1.2, 0.0), 0.3 * Vec3::Y, 0.3 * Vec3::Z);
    add_lights(&mut scene, &light);
    scene.environment = Some(map_of(16, 8, |column, row| {
        Rgb::gray(if (column, row) == (11, 2) { 30.0 } else { 0.2 * hash(column, row) })
    }));
    let plain = Scene::new(&scene);
    let exact = mean(&plain, Technique::Mis, 6, 300);
    for technique in [Technique::Bsdf, Technique::Nee] {
        let found = mean(&plain, technique, 6, 300);
        let allowed = found.margin(ALPHA) + exact.margin(ALPHA);
        assert!(
            (found.mean - exact.mean).abs() < allowed,
            "{technique}: {} {} ± {allowed}",
            found.mean,
            exact.mean
        );
        assert!(allowed < 0.05 * exact.mean, "{technique}: sees only {allowed} of {}", exact.mean);
    }
    // Without the environment it is the path tracer of the previous sheet.
    scene.environment = None;
    scene.lights.push(LightDescription::Point { position: Vec3::new(0.0, 2.0, 2.0), power: Rgb::gray(20.0) });
    let dark = Scene::new(&scene);
    assert!(mean(&dark, Technique::Mis, 2, 10).mean > 0.0);
}
