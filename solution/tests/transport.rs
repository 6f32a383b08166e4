//! The solution agrees with closed forms of light transport.
//!
//! Statistical tests: 42 means at 1e-6 each (Student's t over 64 batches); a correct program fails with a probability
//! below 5e-5, and seeds are fixed. Each test also asserts its resolution, the bias that it detects with a
//! probability of at least one half: 0.5 % in furnaces and between planes, 1 to 5 % elsewhere.

#[path = "../../skeleton/tests/common/mod.rs"]
mod common;
#[path = "../src/algorithms/render_pt.rs"]
pub mod render_pt;

use std::f64::consts::PI;

use arty::math::{Rgb, Vec3};
use arty::prelude::{Integrator, Settings, Technique};
use arty::render::sample_pixel;
use arty::sampler::Streams;
use arty::scene::{LightDescription, Material, Scene, SceneDescription};
use common::scenes::{add, add_lights, black, diffuse, empty, glass, icosphere, mirror, phong, quad, room};
use common::statistics::Estimate;
use render_pt::PathTracer;

const ALPHA: f64 = 1e-6;
/// Relative rounding error of the sum over a path in single precision.
const ROUNDING: f64 = 1e-4;
/// The relative bias that each test must detect.
const RESOLUTION: f64 = 5e-3;
const BATCHES: u64 = 64;

/// The mean of the green channel over an image of 8 × 8 pixels, from batches with different seeds.
fn mean(scene: &Scene, technique: Technique, max_bounces: u32, samples: u64) -> Estimate {
    let tracer = PathTracer::new(Settings { technique, max_bounces });
    let camera = scene.camera(8, 8);
    let batch = |seed: u64| {
        let samples = samples.div_ceil(BATCHES * 64);
        let pixels =
            (0..64).flat_map(|pixel| (0..samples).map(move |sample| ((pixel % 8, pixel / 8), sample)));
        let sum: f64 = pixels
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
    Estimate::of((0..BATCHES).map(batch))
}

fn grey(reflectance: f32, emission: f32) -> Material {
    Material { emission: Rgb::gray(emission), ..diffuse(reflectance) }
}

/// A closed sphere of 320 triangles around the camera, with its front inside.
fn sphere(material: Material) -> SceneDescription {
    let mut scene = empty();
    add(&mut scene, &icosphere(Vec3::ZERO, 2.0, 2, false), material);
    scene
}

#[test]
fn a_diffuse_furnace_is_the_geometric_series() {
    let (radiance, reflectance) = (1.5, 0.6);
    let scene = Scene::new(&sphere(grey(reflectance, radiance as f32)));
    let r = f64::from(reflectance);
    for technique in Technique::ALL {
        for k in [0, 1, 2, 8] {
            let exact = radiance * (1.0 - r.powi(k + 1)) / (1.0 - r);
            // Russian roulette, which applies from the fifth bounce, causes most of the variance.
            let samples = if k > 4 { 130_000 } else { 40_000 };
            let estimate = mean(&scene, technique, k as u32, samples);
            let what = format!("{technique}, {k} bounces");
            if k == 0 {
                assert_eq!(estimate.mean, exact, "{what}: only what the camera sees");
            } else {
                estimate.assert_is(exact, ROUNDING, RESOLUTION, ALPHA, &what);
            }
        }
    }
}

#[test]
fn a_phong_furnace_is_correct_for_one_bounce() {
    // At normal incidence a Phong lobe reflects ks; this holds at the centre of each face of the icosahedron.
    let triangles = icosphere(Vec3::ZERO, 2.0, 2, false);
    let off_axis =
        |[a, b, c]: &[Vec3; 3]| (*b - *a).cross(*c - *a).normalize().dot((*a + *b + *c).normalize());
    let middle = triangles.iter().min_by(|a, b| off_axis(a).total_cmp(&off_axis(b))).expect("320 triangles");
    let mut description = sphere(Material { emission: Rgb::WHITE, ..phong(0.5, 20.0) });
    description.camera.center = (middle[0] + middle[1] + middle[2]) / 3.0;
    description.camera.fov = 0.2;
    let scene = Scene::new(&description);
    for technique in Technique::ALL {
        // A point on one of 320 lights is rarely within the lobe.
        let (samples, resolution) =
            if technique == Technique::Nee { (300_000, 1e-2) } else { (60_000, RESOLUTION) };
        mean(&scene, technique, 1, samples).assert_is(1.5, ROUNDING, resolution, ALPHA, technique.name());
    }
}

#[test]
fn light_between_parallel_planes_agrees_with_its_closed_form() {
    let (emission, lower, upper) = (1.0, 0.5, 0.7);
    let (l, r1, r2) = (1.0, 0.5, 0.7);
    // The planes are 4000 times as large as their distance: one in thousands of paths of sixty bounces leaves them.
    let size = 4000.0;
    let mut scene = empty();
    let low = quad(Vec3::new(-size, 0.0, -size), 2.0 * size * Vec3::Z, 2.0 * size * Vec3::X);
    let high = quad(Vec3::new(-size, 1.0, -size), 2.0 * size * Vec3::X, 2.0 * size * Vec3::Z);
    add(&mut scene, &low, grey(lower, emission));
    add(&mut scene, &high, diffuse(upper));
    scene.camera.eye = Vec3::new(0.3, 0.5, 0.2);
    scene.camera.up = Vec3::Z;
    // Samples of such a large light are almost all far away, so this is for BSDF sampling.
    for technique in [Technique::Bsdf, Technique::Mis] {
        for (down, exact) in [(true, l / (1.0 - r1 * r2)), (false, r2 * l / (1.0 - r1 * r2))] {
            scene.camera.center = scene.camera.eye + if down { Vec3::NEG_Y } else { Vec3::Y };
            let estimate = mean(&Scene::new(&scene), technique, 60, 500_000);
            let what = format!("{technique}, downwards: {down}");
            estimate.assert_is(exact, 5e-4, RESOLUTION, ALPHA, &what);
        }
    }
}

/// A sphere whose triangles above a height emit: the fraction of the sphere, and the scene.
fn sphere_with_cap(reflectance: f32, cap_reflectance: f32) -> (f64, SceneDescription) {
    let triangles = icosphere(Vec3::ZERO, 2.0, 3, false);
    // The irradiance from a part of a sphere is proportional to its area everywhere on the sphere. This holds approximately
    // for a polyhedron; the solid angles of its faces from the centre are the areas on the true sphere.
    let area = |[a, b, c]: &[Vec3; 3]| {
        let [a, b, c] = [a, b, c].map(|corner| corner.as_dvec3() / 2.0);
        2.0 * a.dot(b.cross(c)).abs().atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a))
    };
    let (cap, rest): (Vec<_>, Vec<_>) =
        triangles.into_iter().partition(|[a, b, c]| (a.y + b.y + c.y) / 3.0 > 1.2);
    let share = cap.iter().map(area).sum::<f64>() / (4.0 * PI);
    let mut scene = empty();
    add(&mut scene, &rest, diffuse(reflectance));
    add(&mut scene, &cap, grey(cap_reflectance, 2.0));
    // The camera looks at the wall, not at the cap.
    scene.camera.center = Vec3::new(0.0, -0.6, -1.0);
    (share, scene)
}

#[test]
fn a_cap_illuminates_a_sphere_uniformly() {
    let (l, r) = (2.0, 0.5f64);
    for reflecting in [true, false] {
        let (f, description) = sphere_with_cap(0.5, if reflecting { 0.5 } else { 0.0 });
        // Four bounces of the series, before Russian roulette adds variance.
        let kept = r * if reflecting { 1.0 } else { 1.0 - f };
        let exact = r * f * l * (1.0 - kept.powi(4)) / (1.0 - kept);
        let scene = Scene::new(&description);
        for (technique, samples, resolution) in [
            (Technique::Bsdf, 150_000, 2.5e-2),
            (Technique::Nee, 30_000, 1e-2),
            (Technique::Mis, 30_000, 1e-2),
        ] {
            let what = format!("{technique}, reflecting cap: {reflecting}");
            // Chords of 9° instead of a sphere: a few tenths of a percent.
            mean(&scene, technique, 4, samples).assert_is(exact, 3e-3, resolution, ALPHA, &what);
        }
    }
}

#[test]
fn a_point_light_at_the_centre_of_a_sphere_agrees_with_its_closed_form() {
    let (power, reflectance) = (50.0, 0.5);
    let triangles = icosphere(Vec3::ZERO, 2.0, 3, false);
    let area: f64 =
        triangles.iter().map(|[a, b, c]| 0.5 * f64::from((*b - *a).cross(*c - *a).length())).sum();
    let mut description = empty();
    add(&mut description, &triangles, diffuse(reflectance));
    description.lights.push(LightDescription::Point { position: Vec3::ZERO, power: Rgb::gray(power) });
    // Next to the light, which is invisible, so that no ray starts at it.
    description.camera.eye = Vec3::new(0.1, 0.05, 0.0);
    let scene = Scene::new(&description);
    // ρI / (πR²) with Φ = 4πI and the area of the polyhedron instead of 4πR²; four bounces of the series.
    let r = f64::from(reflectance);
    let exact = f64::from(power) / (PI * area) * r * (1.0 - r.powi(4)) / (1.0 - r);
    for technique in [Technique::Nee, Technique::Mis] {
        // The distance of the faces varies by 1 − cos 4.6° = 0.3 %, and so their irradiance by ± 0.35 % of its mean.
        mean(&scene, technique, 4, 10_000).assert_is(exact, 3.5e-3, RESOLUTION, ALPHA, technique.name());
    }
    // Paths never hit a point light.
    assert_eq!(mean(&scene, Technique::Bsdf, 40, 4_096).mean, 0.0);
}

#[test]
fn mirrors_and_glass_are_invisible_in_a_furnace() {
    for (name, material) in [("mirror", mirror(1.0)), ("glass", glass(1.5))] {
        // Black emitting walls: whatever the path, it ends at radiance 1.
        let mut description = sphere(grey(0.0, 1.0));
        let ball = icosphere(Vec3::new(0.0, 0.0, -1.2), 0.4, 1, true);
        add(&mut description, &ball, material);
        let scene = Scene::new(&description);
        for technique in Technique::ALL {
            let what = format!("{name}, {technique}");
            mean(&scene, technique, 400, 150_000).assert_is(1.0, ROUNDING, RESOLUTION, ALPHA, &what);
        }
    }
}

#[test]
fn radiance_inside_glass_is_scaled_by_the_squared_index() {
    let mut description = sphere(grey(0.0, 1.0));
    add(&mut description, &icosphere(Vec3::ZERO, 0.5, 2, true), glass(1.5));
    let scene = Scene::new(&description);
    for technique in Technique::ALL {
        mean(&scene, technique, 400, 60_000).assert_is(2.25, ROUNDING, RESOLUTION, ALPHA, technique.name());
    }
}

/// A room with all kinds of objects, lit by the given lights. The other lights are black occluders.
fn mixed_room(lights: &[usize]) -> Scene {
    let mut scene = empty();
    add(&mut scene, &room(Vec3::new(-2.0, -1.0, -4.0), Vec3::new(2.0, 2.0, 1.0)), diffuse(0.5));
    let floor = Material { diffuse: Rgb::gray(0.3), ..phong(0.4, 30.0) };
    add(&mut scene, &quad(Vec3::new(-1.5, -0.9, -3.5), 3.0 * Vec3::Z, 3.0 * Vec3::X), floor);
    let coated = Material { diffuse: Rgb::gray(0.4), ..mirror(0.3) };
    add(&mut scene, &icosphere(Vec3::new(0.8, -0.4, -2.5), 0.45, 0, true), coated);
    // Off the ceiling, so that no surface is arbitrarily close to it.
    let panel = quad(Vec3::new(-0.6, 1.5, -2.8), 1.2 * Vec3::X, 1.2 * Vec3::Z);
    let sail = vec![[Vec3::new(-1.2, -0.2, -3.0), Vec3::new(-0.9, 0.0, -2.2), Vec3::new(-1.2, 0.6, -2.8)]];
    for (number, triangles) in [panel, sail].iter().enumerate() {
        if lights.contains(&number) {
            add_lights(&mut scene, triangles);
        } else {
            add(&mut scene, triangles, black());
        }
    }
    if lights.contains(&2) {
        let position = Vec3::new(0.5, 1.0, -0.5);
        scene.lights.push(LightDescription::Point { position, power: Rgb::gray(8.0) });
    }
    if lights.contains(&3) {
        let (position, direction) = (Vec3::new(-0.5, 1.0, -1.0), Vec3::new(0.3, -1.0, -0.9));
        let power = Rgb::gray(5.0);
        scene.lights.push(LightDescription::Spot { position, direction, inner: 15.0, outer: 35.0, power });
    }
    Scene::new(&scene)
}

/// Asserts that two independent estimates agree (normal approximation of their difference).
fn assert_agree(a: Estimate, b: Estimate, resolution: f64, what: &str) {
    let allowed = (a.margin(ALPHA).powi(2) + b.margin(ALPHA).powi(2)).sqrt();
    assert!((a.mean - b.mean).abs() <= allowed, "{what}: {a:?} and {b:?}");
    assert!(allowed <= resolution * a.mean, "{what}: sees only differences from {}", allowed / a.mean);
}

#[test]
fn all_techniques_agree_for_area_lights() {
    let scene = mixed_room(&[0, 1]);
    for bounces in [1, 4] {
        let bsdf = mean(&scene, Technique::Bsdf, bounces, 1_200_000);
        let nee = mean(&scene, Technique::Nee, bounces, 500_000);
        let mis = mean(&scene, Technique::Mis, bounces, 500_000);
        assert_agree(mis, bsdf, 0.045, &format!("mis and bsdf, {bounces} bounces"));
        assert_agree(mis, nee, 0.05, &format!("mis and nee, {bounces} bounces"));
    }
}

#[test]
fn light_is_additive() {
    let together = mixed_room(&[0, 1, 2, 3]);
    let alone = [0, 1, 2, 3].map(|light| mixed_room(&[light]));
    for technique in [Technique::Nee, Technique::Mis] {
        let all = mean(&together, technique, 3, 600_000);
        let parts = alone.each_ref().map(|scene| mean(scene, technique, 3, 200_000));
        let sum: f64 = parts.iter().map(|part| part.mean).sum();
        let margin =
            parts.iter().map(|part| part.margin(ALPHA).powi(2)).sum::<f64>() + all.margin(ALPHA).powi(2);
        let allowed = margin.sqrt();
        assert!((all.mean - sum).abs() <= allowed, "{technique}: {} and {sum} ± {allowed}", all.mean);
        assert!(allowed <= 0.025 * sum, "{technique}: sees only differences from {}", allowed / sum);
    }
}

#[test]
fn direct_light_from_a_polygon_agrees_with_its_closed_form() {
    // A diffuse floor under a rectangle: L = ρ E / π at the point seen by a narrow camera.
    let mut scene = empty();
    add(&mut scene, &quad(Vec3::new(-5.0, 0.0, -5.0), 10.0 * Vec3::Z, 10.0 * Vec3::X), diffuse(0.8));
    let light = quad(Vec3::new(0.2, 1.0, -0.5), 1.0 * Vec3::X, 1.5 * Vec3::Z);
    add_lights(&mut scene, &light);
    scene.camera.eye = Vec3::new(-1.0, 0.7, 0.0);
    scene.camera.center = Vec3::ZERO;
    scene.camera.fov = 0.05;
    let scene = Scene::new(&scene);
    let exact: f64 = light
        .iter()
        .map(|corners| {
            common::formulas::polygon(&corners.map(Vec3::as_dvec3), glam::DVec3::ZERO, glam::DVec3::Y)
        })
        .sum::<f64>()
        * 0.8
        / PI;
    for (technique, samples) in
        [(Technique::Bsdf, 3_000_000), (Technique::Nee, 300_000), (Technique::Mis, 300_000)]
    {
        mean(&scene, technique, 1, samples).assert_is(exact, 5e-4, 1e-2, ALPHA, technique.name());
    }
}

#[test]
fn all_techniques_count_bounces_in_the_same_way() {
    let scene = mixed_room(&[0, 1]);
    // Emission only, for all techniques.
    let seen = Technique::ALL.map(|technique| mean(&scene, technique, 0, 4_096).mean);
    assert!(seen[0] > 0.0 && seen[0] == seen[1] && seen[1] == seen[2], "{seen:?}");
    // A point light is invisible and contributes from one bounce.
    let point = mixed_room(&[2]);
    assert_eq!(mean(&point, Technique::Nee, 0, 4_096).mean, 0.0);
    assert!(mean(&point, Technique::Nee, 1, 4_096).mean > 0.0);
}

/// The tests above can fail.
#[test]
fn a_missing_bounce_and_a_wrong_weight_are_rejected() {
    let scene = Scene::new(&sphere(grey(0.6, 1.5)));
    let exact = |k: i32| 1.5 * (1.0 - 0.6f64.powi(k + 1)) / 0.4;
    for technique in Technique::ALL {
        assert!(mean(&scene, technique, 3, 6_000).rejects(exact(4), ALPHA));
        // Light counted twice, or half.
        let direct = mean(&scene, technique, 1, 6_000);
        assert!(direct.rejects(1.5 + 2.0 * 1.5 * 0.6, ALPHA) && direct.rejects(1.5 + 0.5 * 1.5 * 0.6, ALPHA));
    }
}
