//! Irradiance from lights agrees with closed forms, estimated both by light sampling and by BSDF sampling.
//!
//! Statistical tests: 24 estimates at 1e-6 each; a correct program fails with a probability below 3e-5. Those
//! with light sampling detect a bias of 1 %, those with BSDF sampling one of 5 %, with a probability of at least one half.

#[path = "../../skeleton/tests/common/mod.rs"]
mod common;

use std::f64::consts::PI;

use arty::light::Light;
use arty::math::{Rgb, Vec3, direction_and_distance};
use arty::ray::Ray;
use arty::sampler::Sampler;
use arty::scene::{LightDescription, Scene, SceneDescription};
use common::formulas;
use common::scenes::{add, add_lights, diffuse, empty, icosphere, quad, tilted};
use common::statistics::Estimate;
use glam::DVec3;

const ALPHA: f64 = 1e-6;

/// Irradiance at the origin on a surface with the given normal, by one sample of each light, without occlusion:
/// Σ I cos θ cos θ_L / (p d²).
fn by_light_sampling(scene: &Scene, normal: Vec3, samples: u64, seed: u64) -> Estimate {
    Estimate::of((0..samples).map(|sample| {
        let mut sampler = Sampler::new(seed, (0, 0), sample);
        let of_light = |light: &Light| {
            let Some(sample) = light.sample_direct(Vec3::ZERO, &mut sampler) else { return 0.0 };
            let (wi, distance) = direction_and_distance(Vec3::ZERO, sample.point);
            let geometry = f64::from(normal.dot(wi).max(0.0)) * f64::from(sample.cos_light)
                / f64::from(distance).powi(2);
            f64::from(sample.emitted.g) * geometry / f64::from(sample.pdf_area)
        };
        scene.lights().iter().map(of_light).sum()
    }))
}

/// The same by sampling the BSDF of a white diffuse surface at the origin: E = π · mean of L.
fn by_bsdf_sampling(description: &SceneDescription, normal: Vec3, samples: u64, seed: u64) -> Estimate {
    let mut description = description.clone();
    let (a, b) = normal.any_orthonormal_pair();
    let size = 1e-2;
    add(&mut description, &[[-size * a - size * b, size * a - size * b, 2.0 * size * b]], diffuse(1.0));
    let scene = Scene::new(&description);
    let hit = scene.intersect(&Ray::new(0.5 * normal, -normal)).expect("the receiver stands in the origin");
    let bsdf = hit.bsdf();
    Estimate::of((0..samples).map(|sample| {
        let mut sampler = Sampler::new(seed, (1, 0), sample);
        let Some(sample) = bsdf.sample(&mut sampler) else { return 0.0 };
        let Some(there) = scene.intersect(&hit.spawn(sample.wi)) else { return 0.0 };
        let Some(emission) = there.emission() else { return 0.0 };
        PI * f64::from(sample.f.g * sample.cos / sample.pdf * emission.radiance.g)
    }))
}

fn triangle_lights(triangles: &[[Vec3; 3]]) -> SceneDescription {
    let mut scene = empty();
    add_lights(&mut scene, triangles);
    scene
}

#[test]
fn a_point_light_obeys_the_inverse_square_and_cosine_laws() {
    let power = Rgb::new(1.0, 10.0, 100.0);
    for distance in [1e-3, 0.1, 1.0, 25.0, 1e4] {
        for theta in [0.0f32, 30.0, 75.0, 100.0] {
            let mut scene = empty();
            scene.lights.push(LightDescription::Point { position: distance * tilted(theta, 2.0), power });
            let e = by_light_sampling(&Scene::new(&scene), Vec3::Z, 2, 1).mean;
            let cos = f64::from(theta).to_radians().cos().max(0.0);
            let exact = f64::from(power.g) / (4.0 * PI) * cos / f64::from(distance).powi(2);
            assert!((e - exact).abs() <= 3e-6 * exact, "{distance}, {theta}°: {e}, expected {exact}");
        }
    }
}

#[test]
fn triangles_and_rectangles_obey_lamberts_formula() {
    // All of it is above the horizon and seen from the front.
    let shapes = [
        vec![[Vec3::new(-0.5, -0.4, 1.0), Vec3::new(0.1, 0.8, 1.5), Vec3::new(0.7, -0.3, 0.9)]],
        vec![[Vec3::new(3.0, 0.2, 0.1), Vec3::new(3.2, -1.0, 2.0), Vec3::new(2.8, 1.5, 2.5)]],
        quad(Vec3::new(-0.5, -0.5, 2.0), 1.5 * Vec3::Y, 2.0 * Vec3::X),
        quad(Vec3::new(1.0, 1.0, 1.0), Vec3::new(0.0, 1.0, 0.2), Vec3::new(1.0, 0.0, 0.3)),
    ];
    for (number, triangles) in shapes.iter().enumerate() {
        let description = triangle_lights(triangles);
        let scene = Scene::new(&description);
        for normal in [Vec3::Z, tilted(20.0, 0.7)] {
            let exact: f64 = triangles
                .iter()
                .map(|corners| {
                    formulas::polygon(&corners.map(Vec3::as_dvec3), DVec3::ZERO, normal.as_dvec3())
                })
                .sum();
            let seed = number as u64;
            let what = format!("shape {number}, {normal}");
            by_light_sampling(&scene, normal, 200_000, seed).assert_is(exact, 1e-5, 0.01, ALPHA, &what);
            by_bsdf_sampling(&description, normal, 3_000_000, seed)
                .assert_is(exact, 1e-5, 0.05, ALPHA, &what);
        }
    }
}

#[test]
fn a_rectangle_with_a_corner_overhead_agrees_with_its_closed_form() {
    for (a, b, h) in [(1.0, 1.0, 1.0), (3.0, 0.5, 0.7), (0.2, 0.1, 2.0)] {
        // Facing down.
        let scene = Scene::new(&triangle_lights(&quad(h * Vec3::Z, b * Vec3::Y, a * Vec3::X)));
        let exact = formulas::corner_rectangle(f64::from(a), f64::from(b), f64::from(h));
        by_light_sampling(&scene, Vec3::Z, 400_000, 3).assert_is(
            exact,
            1e-5,
            0.01,
            ALPHA,
            &format!("{a} × {b} at {h}"),
        );
    }
}

#[test]
fn a_disk_agrees_with_its_closed_form_centred_and_off_centre() {
    const CORNERS: usize = 512;
    // The area of the polygon is smaller by 1 − sin(2π/n) / (2π/n) = 2.5e-5 than that of the disk.
    let rounding = 1e-4;
    for (r, h, a) in [(1.0, 1.0, 0.0), (0.5, 1.0, 0.8), (1.0, 0.5, 2.0)] {
        let rim = |i: usize| {
            let phi = i as f64 / CORNERS as f64 * std::f64::consts::TAU;
            (DVec3::new(a, 0.0, h) + r * DVec3::new(phi.cos(), -phi.sin(), 0.0)).as_vec3()
        };
        let center = DVec3::new(a, 0.0, h).as_vec3();
        let triangles: Vec<_> = (0..CORNERS).map(|i| [center, rim(i), rim(i + 1)]).collect();
        let scene = Scene::new(&triangle_lights(&triangles));
        let exact = formulas::disk(r, h, a);
        by_light_sampling(&scene, Vec3::Z, 4_000, 4).assert_is(
            exact,
            rounding,
            0.01,
            ALPHA,
            &format!("{r}, {h}, {a}"),
        );
    }
}

#[test]
fn a_sphere_illuminates_like_a_point_at_its_centre() {
    let (radius, distance) = (0.8f32, 3.0f32);
    for theta in [0.0, 50.0] {
        let triangles = icosphere(distance * tilted(theta, 1.0), radius, 3, true);
        let description = triangle_lights(&triangles);
        let scene = Scene::new(&description);
        // The polyhedron exactly, by Lambert's formula for all front faces.
        let lit: f64 = triangles
            .iter()
            .map(|corners| corners.map(Vec3::as_dvec3))
            .filter(|[a, b, c]| (b - a).cross(c - a).dot(*a) < 0.0)
            .map(|corners| formulas::polygon(&corners, DVec3::ZERO, DVec3::Z))
            .sum();
        by_light_sampling(&scene, Vec3::Z, 2_000, 5).assert_is(lit, 1e-4, 0.01, ALPHA, &format!("{theta}°"));
        // The sphere approximately: edges after three subdivisions are chords of 9°, at most sin²(4.6°) = 0.6 % of the
        // cross-section.
        let sphere =
            formulas::sphere(f64::from(radius), f64::from(distance), f64::from(theta).to_radians().cos());
        assert!(lit < sphere && lit > 0.993 * sphere, "{lit} and {sphere}");
    }
}

#[test]
fn formulas_agree_with_each_other() {
    let corners = [DVec3::ZERO, 0.5 * DVec3::Y, DVec3::new(3.0, 0.5, 0.0), 3.0 * DVec3::X];
    let at_height = corners.map(|corner| corner + 0.7 * DVec3::Z);
    // A corner directly overhead is not a special case of the polygon formula.
    let polygon = formulas::polygon(&at_height, DVec3::ZERO, DVec3::Z);
    assert!((polygon - formulas::corner_rectangle(3.0, 0.5, 0.7)).abs() < 1e-12);
    // Radiance 1 from the whole hemisphere: E = π.
    assert!((formulas::disk(1e6, 1.0, 0.0) - PI).abs() < 1e-6);
    assert!((formulas::corner_rectangle(1e6, 1e6, 1.0) - PI / 4.0).abs() < 1e-5);
}

/// The tests above can fail.
#[test]
fn missing_factors_are_rejected() {
    let triangle = [Vec3::new(-0.5, -0.4, 1.0), Vec3::new(0.1, 0.8, 1.5), Vec3::new(0.7, -0.3, 0.9)];
    let scene = Scene::new(&triangle_lights(&[triangle]));
    let exact = formulas::polygon(&triangle.map(Vec3::as_dvec3), DVec3::ZERO, DVec3::Z);
    let estimate = by_light_sampling(&scene, Vec3::Z, 200_000, 0);
    assert!(!estimate.rejects(exact, ALPHA));
    assert!(estimate.rejects(1.01 * exact, ALPHA) && estimate.rejects(0.99 * exact, ALPHA));
}
