//! Lights: power, densities, cosines, directions of emission. Sampled points are checked one by one; no test is
//! statistical.

mod common;

use std::f64::consts::PI;

use arty::light::Light;
use arty::math::{Rgb, Vec3, direction_and_distance};
use arty::ray::Ray;
use arty::sampler::Sampler;
use arty::scene::{LightDescription, Material, Scene};
use common::quadrature::{Polar, over_ring, spiral};
use common::scenes::{add, black, diffuse, empty, quad, tilted};

fn scene_of(light: LightDescription) -> Scene {
    let mut scene = empty();
    scene.lights.push(light);
    Scene::new(&scene)
}

const AXIS: Vec3 = Vec3::new(0.3, -0.5, 2.0);
const POSITION: Vec3 = Vec3::new(4.0, 5.0, -6.0);

const POWER: Rgb = Rgb::new(3.0, 7.0, 11.0);

const TRIANGLE: [Vec3; 3] = [Vec3::new(1.0, 0.0, 0.0), Vec3::new(3.0, 0.5, 0.0), Vec3::new(1.5, 2.0, 1.0)];

fn triangle() -> Scene {
    scene_of(LightDescription::Triangle { vertices: TRIANGLE, radiance: Rgb::new(1.0, 2.0, 3.0) })
}

/// Unit normal of the front, and area.
fn normal_and_area() -> (Vec3, f32) {
    let [a, b, c] = TRIANGLE;
    let cross = (b - a).cross(c - a);
    (cross.normalize(), 0.5 * cross.length())
}

/// Intensity towards a far point in the direction `w`: luminance, in W/sr.
fn intensity(light: &Light, w: Vec3) -> f64 {
    let mut sampler = Sampler::new(1, (0, 0), 0);
    let center = if light.has_area() { TRIANGLE[0] } else { POSITION };
    light
        .sample_direct(center + 1e4 * w, &mut sampler)
        .map_or(0.0, |sample| f64::from(sample.emitted.luminance() * sample.cos_light / sample.pdf_area))
}

#[test]
fn a_point_light_emits_its_power_uniformly() {
    let scene = scene_of(LightDescription::Point { position: POSITION, power: POWER });
    let light = &scene.lights()[0];
    assert!((light.power() / POWER.luminance() - 1.0).abs() < 1e-6 && !light.has_area());
    for (w, _) in spiral(100) {
        assert!((intensity(light, w) * 4.0 * PI / f64::from(POWER.luminance()) - 1.0).abs() < 1e-6);
    }
    assert!(
        light.sample_direct(POSITION, &mut Sampler::new(0, (0, 0), 0)).is_none(),
        "no distance, no direction"
    );
}

#[test]
fn a_spot_light_emits_all_its_power_into_its_cone() {
    let power = f64::from(POWER.luminance());
    let polar = Polar::around(AXIS.as_dvec3());
    for (inner, outer) in [
        (10.0, 20.0),
        (0.0, 90.0),
        (30.0, 30.0),
        (90.0, 150.0),
        (0.0, 180.0),
        (180.0, 180.0),
        (1.0, 2.0),
        (0.05, 0.1),
    ] {
        // At the origin, where directions to points are exact.
        let (position, direction) = (Vec3::ZERO, AXIS);
        let scene = scene_of(LightDescription::Spot { position, direction, inner, outer, power: POWER });
        let light = &scene.lights()[0];
        assert!(
            (f64::from(light.power()) / power - 1.0).abs() < 1e-5,
            "{inner}°–{outer}°: {}",
            light.power()
        );
        let towards = |w: Vec3| {
            let sample = light.sample_direct(w, &mut Sampler::new(1, (0, 0), 0));
            sample.map_or(0.0, |sample| f64::from(sample.emitted.luminance()))
        };
        let edge = |degrees: f32| 2.0 * (0.5 * f64::from(degrees).to_radians()).sin().powi(2);
        let total: f64 = [(0.0, edge(inner)), (edge(inner), edge(outer)), (edge(outer), 2.0)]
            .into_iter()
            .map(|ring| over_ring(&polar, ring, (0.0, 1.0), 64, &towards))
            .sum();
        assert!((total / power - 1.0).abs() < 1e-3, "{inner}°–{outer}°: {total}, expected {power}");
    }
}

#[test]
fn a_spot_light_falls_off_smoothly_between_its_angles() {
    let (position, direction) = (POSITION, AXIS);
    let scene =
        scene_of(LightDescription::Spot { position, direction, inner: 20.0, outer: 40.0, power: POWER });
    let polar = Polar::around(AXIS.as_dvec3());
    let at =
        |degrees: f64| intensity(&scene.lights()[0], polar.direction(1.0 - degrees.to_radians().cos(), 1.0));
    let full = at(0.0);
    assert!((at(19.9) / full - 1.0).abs() < 1e-6 && at(40.1) == 0.0 && at(170.0) == 0.0);
    for degrees in [22.0f64, 27.0, 31.0, 38.0] {
        let cos = |degrees: f64| degrees.to_radians().cos();
        let t = (cos(degrees) - cos(40.0)) / (cos(20.0) - cos(40.0));
        let expected = t * t * (3.0 - 2.0 * t);
        assert!(
            (at(degrees) / full - expected).abs() < 1e-4,
            "{degrees}°: {}, {expected}",
            at(degrees) / full
        );
    }
}

#[test]
fn the_power_of_a_triangle_is_the_integral_of_its_intensity() {
    let scene = triangle();
    let (light, (normal, area)) = (&scene.lights()[0], normal_and_area());
    let exact = PI * f64::from(area) * f64::from(Rgb::new(1.0, 2.0, 3.0).luminance());
    assert!((f64::from(light.power()) / exact - 1.0).abs() < 1e-6);
    let polar = Polar::around(normal.as_dvec3());
    let total = over_ring(&polar, (0.0, 2.0), (0.0, 1.0), 48, &|w| intensity(light, w));
    assert!((total / exact - 1.0).abs() < 2e-3, "{total}, expected {exact}");
}

#[test]
fn sampled_points_have_the_documented_density_and_cosine() {
    let scene = triangle();
    let (light, (normal, area)) = (&scene.lights()[0], normal_and_area());
    assert!(light.has_area() && light.index() == 0);
    let mut sampler = Sampler::new(2, (0, 0), 0);
    for (w, _) in spiral(3000) {
        let from = TRIANGLE[0] + 5.0 * w;
        let sample = light.sample_direct(from, &mut sampler);
        // A triangle is seen either from its front or from its back as a whole.
        let side = normal.dot(from - TRIANGLE[0]);
        if side.abs() < 1e-4 {
            continue;
        }
        assert_eq!(sample.is_some(), side > 0.0, "{from}");
        let Some(sample) = sample else { continue };
        let [a, b, c] = TRIANGLE;
        assert!(normal.dot(sample.point - a).abs() < 1e-6, "in the plane");
        for (p, q) in [(a, b), (b, c), (c, a)] {
            assert!((q - p).cross(sample.point - p).dot(normal) > -1e-6, "within its edges");
        }
        assert!((sample.pdf_area * area - 1.0).abs() < 1e-6);
        let cos = normal.dot(direction_and_distance(sample.point, from).0);
        assert!((sample.cos_light - cos).abs() < 1e-6 && sample.cos_light > 0.0 && sample.cos_light <= 1.0);
        assert_eq!(sample.emitted, Rgb::new(1.0, 2.0, 3.0));
    }
}

#[test]
fn the_emission_of_a_hit_agrees_with_a_light_sample() {
    let scene = triangle();
    let light = &scene.lights()[0];
    let mut sampler = Sampler::new(3, (0, 0), 0);
    let mut seen = 0;
    for (w, _) in spiral(2000) {
        let from = TRIANGLE[1] + 3.0 * w;
        let Some(sample) = light.sample_direct(from, &mut sampler) else { continue };
        // At grazing angles and near edges, rounding decides whether a ray hits.
        if sample.cos_light < 0.01 {
            continue;
        }
        let Some(hit) = scene.intersect(&Ray::new(from, direction_and_distance(from, sample.point).0)) else {
            continue;
        };
        let emission = hit.emission().expect("it is seen from its front");
        assert_eq!((emission.light.index(), emission.radiance), (light.index(), sample.emitted));
        assert_eq!(emission.pdf_area, sample.pdf_area);
        assert!(
            (emission.cos_light - sample.cos_light).abs() < 1e-5
                && (hit.point - sample.point).length() < 1e-4
        );
        seen += 1;
    }
    assert!(seen > 900, "{seen}");
}

#[test]
fn lights_emit_from_their_front_only() {
    let scene = triangle();
    let (normal, _) = normal_and_area();
    let middle = (TRIANGLE[0] + TRIANGLE[1] + TRIANGLE[2]) / 3.0;
    let front = scene.intersect(&Ray::new(middle + normal, -normal)).expect("it is hit from the front");
    let back = scene.intersect(&Ray::new(middle - normal, normal)).expect("it is hit from the back");
    assert!(front.emission().is_some() && back.emission().is_none());
    // Triangle lights reflect nothing, from either side.
    let mut sampler = Sampler::new(4, (0, 0), 0);
    for hit in [front, back] {
        assert!(hit.bsdf().eval(hit.normal).is_black() && hit.bsdf().sample(&mut sampler).is_none());
    }
}

#[test]
fn an_emissive_mesh_reflects_and_its_lights_follow_the_explicit_ones() {
    let mut scene = empty();
    scene.lights.push(LightDescription::Point { position: Vec3::X, power: Rgb::WHITE });
    scene.lights.push(LightDescription::Triangle { vertices: TRIANGLE, radiance: Rgb::WHITE });
    add(
        &mut scene,
        &quad(Vec3::new(-1.0, -1.0, -3.0), 2.0 * Vec3::X, 2.0 * Vec3::Y),
        Material { emission: Rgb::gray(4.0), ..diffuse(0.5) },
    );
    let scene = Scene::new(&scene);
    let kinds: Vec<bool> = scene.lights().iter().map(Light::has_area).collect();
    assert_eq!(kinds, [false, true, true, true]);
    assert!(scene.lights().iter().enumerate().all(|(index, light)| light.index() == index));
    let hit =
        scene.intersect(&Ray::new(Vec3::new(0.3, 0.1, 0.0), Vec3::NEG_Z)).expect("the quad is in the way");
    let emission = hit.emission().expect("it emits");
    assert!(emission.light.index() >= 2 && emission.radiance == Rgb::gray(4.0));
    assert!((hit.bsdf().eval(Vec3::Z).g * std::f32::consts::PI - 0.5).abs() < 1e-6);
}

#[test]
fn lights_with_unrepresentable_areas_are_ignored_with_a_warning() {
    let mut scene = empty();
    for size in [0.0, 1e-25, 1.0, 1e25] {
        let vertices = [Vec3::ZERO, size * Vec3::X, size * Vec3::Y];
        scene.lights.push(LightDescription::Triangle { vertices, radiance: Rgb::WHITE });
        add(
            &mut scene,
            &[vertices.map(|vertex| vertex + Vec3::Z)],
            Material { emission: Rgb::WHITE, ..black() },
        );
    }
    let scene = Scene::new(&scene);
    assert_eq!(scene.lights().len(), 2);
    assert_eq!(scene.warnings().len(), 1, "{:?}", scene.warnings());
    let mut sampler = Sampler::new(5, (0, 0), 0);
    for light in scene.lights() {
        let sample =
            light.sample_direct(tilted(20.0, 0.0) * 3.0, &mut sampler).expect("it is seen from the front");
        assert!(sample.pdf_area == 2.0);
    }
}

/// A square in the plane z = 0, once facing +z and once facing −z or +z again.
fn doubled(second_faces_back: bool) -> Scene {
    let mut scene = empty();
    let square = quad(Vec3::ZERO, Vec3::X, Vec3::Y);
    let turned = |&[a, b, c]: &[Vec3; 3]| if second_faces_back { [a, c, b] } else { [a, b, c] };
    let other: Vec<_> = square.iter().map(turned).collect();
    add(&mut scene, &square, Material { emission: Rgb::WHITE, ..black() });
    add(&mut scene, &other, Material { emission: Rgb::gray(2.0), ..black() });
    Scene::new(&scene)
}

#[test]
fn a_two_sided_light_is_hit_and_sampled_from_both_sides() {
    let scene = doubled(true);
    assert_eq!(scene.lights().len(), 4);
    for (side, radiance) in [(1.0, 1.0), (-1.0, 2.0)] {
        let from = Vec3::new(0.3, 0.4, side);
        let hit = scene.intersect(&Ray::new(from, Vec3::new(0.0, 0.0, -side))).expect("the square is there");
        let emission = hit.emission().expect("each side is a light");
        assert_eq!(emission.radiance, Rgb::gray(radiance));
        let seen: Vec<_> = scene
            .lights()
            .iter()
            .filter_map(|light| light.sample_direct(from, &mut Sampler::new(0, (0, 0), 0)))
            .collect();
        assert_eq!(seen.len(), 2, "the two triangles that face this side");
        assert!(seen.iter().all(|sample| sample.emitted == Rgb::gray(radiance)));
    }
}

#[test]
fn of_two_duplicate_lights_only_the_one_that_rays_hit_is_kept() {
    let scene = doubled(false);
    assert_eq!(scene.lights().len(), 2);
    assert!(scene.lights().iter().enumerate().all(|(index, light)| light.index() == index));
    let hit = scene.intersect(&Ray::new(Vec3::new(0.3, 0.4, 1.0), Vec3::NEG_Z)).expect("the square is there");
    let emission = hit.emission().expect("it is a light");
    assert_eq!(emission.radiance, Rgb::WHITE);
    assert!(scene.warnings()[0].contains("are ignored: "));
}
