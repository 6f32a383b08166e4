//! Rendering: threads, passes, replay, anomalies, textures, settings.

mod common;
#[path = "../src/algorithms/render_pt.rs"]
pub mod render_pt;

use std::f64::consts::PI;
use std::sync::atomic::AtomicBool;

use arty::film::{Anomalies, Film};
use arty::math::{Rgb, Vec2, Vec3};
use arty::prelude::{Integrator, Sampler, Settings, Technique};
use arty::ray::Ray;
use arty::render::{render, sample_pixel};
use arty::sampler::{SamplerKind, Streams};
use arty::scene::{LightDescription, Material, Scene, Texture};
use arty::srgb::srgb_to_linear_u8;
use common::scenes::{add, diffuse, empty, phong, quad, room};
use render_pt::PathTracer;

const SEED: u64 = 11;

fn lit_room() -> Scene {
    let mut scene = empty();
    add(
        &mut scene,
        &room(Vec3::new(-1.0, -1.0, -2.0), Vec3::new(1.0, 1.0, 1.0)),
        Material { emission: Rgb::new(0.1, 0.2, 0.3), ..diffuse(0.5) },
    );
    let lid = Material { diffuse: Rgb::new(0.3, 0.2, 0.1), ..phong(0.5, 30.0) };
    add(&mut scene, &quad(Vec3::new(-0.5, -0.5, -1.5), Vec3::X, Vec3::Y), lid);
    Scene::new(&scene)
}

fn tracer(max_bounces: u32) -> PathTracer {
    PathTracer::new(Settings { technique: Technique::Bsdf, max_bounces })
}

/// Renders in passes between consecutive bounds of sample numbers, in a pool with the given number of threads.
fn film(
    integrator: &dyn Integrator,
    scene: &Scene,
    threads: usize,
    bounds: &[u64],
    streams: Streams,
) -> Film {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be started");
    let mut film = Film::new(13, 7);
    for pass in bounds.windows(2) {
        pool.install(|| {
            render(integrator, scene, &mut film, pass[0]..pass[1], streams, &AtomicBool::new(false))
        });
    }
    film
}

#[test]
fn images_do_not_depend_on_threads_or_passes() {
    let (scene, tracer) = (lit_room(), tracer(6));
    for kind in [SamplerKind::Independent, SamplerKind::Sobol] {
        let film = |threads, bounds, seed| film(&tracer, &scene, threads, bounds, Streams { seed, kind });
        let expected = film(1, &[0, 12], SEED);
        assert_eq!(expected.samples(), 12);
        for threads in [1, 2, 3, 8] {
            for bounds in [&[0, 12][..], &[0, 1, 12], &[0, 5, 5, 9, 12]] {
                let other = film(threads, bounds, SEED);
                assert!(expected.pixels() == other.pixels(), "{kind:?}, {threads} threads, {bounds:?}");
            }
        }
        let different = film(1, &[0, 12], SEED + 1);
        assert!(
            expected.pixels().iter().zip(different.pixels()).all(|(a, b)| a != b),
            "{kind:?}: another seed, another image"
        );
    }
}

#[test]
fn any_path_can_be_replayed() {
    let (scene, tracer) = (lit_room(), tracer(6));
    let film = film(&tracer, &scene, 2, &[0, 4], Streams::independent(SEED));
    let camera = scene.camera(13, 7);
    for (place, pixel) in film.pixels().iter().enumerate() {
        let at = (place as u32 % 13, place as u32 / 13);
        let sum: f64 = (0..4)
            .map(|sample| {
                f64::from(sample_pixel(&tracer, &scene, &camera, Streams::independent(SEED), at, sample).g)
            })
            .sum();
        assert_eq!((pixel.count, pixel.sum[1]), (4, sum));
    }
}

#[test]
fn no_pixel_is_started_after_a_stop() {
    let scene = lit_room();
    let mut film = Film::new(4, 4);
    render(&tracer(2), &scene, &mut film, 0..4, Streams::independent(SEED), &AtomicBool::new(true));
    assert_eq!(film.samples(), 0);
    assert!(film.pixels().iter().all(|pixel| pixel.count == 0 && pixel.mean() == Rgb::BLACK));
}

#[test]
fn films_without_pixels_can_be_rendered() {
    for (width, height) in [(0, 0), (0, 3), (3, 0)] {
        let mut film = Film::new(width, height);
        render(&tracer(2), &lit_room(), &mut film, 0..4, Streams::independent(SEED), &AtomicBool::new(false));
        assert_eq!(film.samples(), 0);
    }
}

/// Returns anomalies for a third of all samples.
struct Faulty;

impl Integrator for Faulty {
    fn radiance(&self, _: &Scene, _: Ray, sampler: &mut Sampler) -> Rgb {
        match (sampler.next_1d() * 9.0) as u32 {
            0 => Rgb::new(1.0, f32::NAN, 1.0),
            1 => Rgb::new(f32::INFINITY, -1.0, 1.0),
            2 => Rgb::new(1.0, 1.0, -0.5),
            _ => Rgb::WHITE,
        }
    }
}

#[test]
fn anomalies_are_counted_and_the_first_are_kept_for_any_passes() {
    let scene = Scene::new(&empty());
    let camera = scene.camera(13, 7);
    let mut all = Vec::new();
    for sample in 0..10 {
        for (y, x) in (0..7).flat_map(|y| (0..13).map(move |x| (y, x))) {
            let value = sample_pixel(&Faulty, &scene, &camera, Streams::independent(SEED), (x, y), sample);
            if value != Rgb::WHITE {
                all.push((sample, y, x, value.is_finite()));
            }
        }
    }
    for threads in [1, 3] {
        for bounds in [&[0, 10][..], &[0, 3, 4, 10]] {
            let film = film(&Faulty, &scene, threads, bounds, Streams::independent(SEED));
            let anomalies = film.anomalies();
            let negative = all.iter().filter(|(.., finite)| *finite).count() as u64;
            assert!(negative > 50 && !anomalies.is_empty());
            assert_eq!((anomalies.negative, anomalies.non_finite), (negative, all.len() as u64 - negative));
            let named: Vec<_> =
                anomalies.first.iter().map(|it| (it.sample, it.y, it.x, it.value.is_finite())).collect();
            assert_eq!(named, all[..Anomalies::KEPT], "{threads} threads, {bounds:?}");
            assert!(film.pixels().iter().all(|pixel| pixel.count == 10 && pixel.mean().is_finite()));
        }
    }
}

#[test]
fn textures_scale_the_diffuse_albedo() {
    let mut scene = empty();
    add(&mut scene, &quad(Vec3::new(-1.0, -1.0, -1.0), 2.0 * Vec3::X, 2.0 * Vec3::Y), diffuse(0.5));
    let texels = vec![[255, 0, 0], [0, 255, 0], [10, 100, 200], [255; 3]];
    scene.textures.push(Texture { width: 2, height: 2, texels: texels.clone() });
    scene.materials[0].diffuse_map = Some(0);
    let mesh = &mut scene.meshes[0];
    mesh.uvs =
        mesh.positions.iter().map(|position| Vec2::new(position.x + 1.0, position.y + 1.0) / 2.0).collect();
    for triangle in &mut mesh.triangles {
        triangle.uvs = Some(triangle.positions);
    }
    let built = Scene::new(&scene);
    // Texel centres, the upper row first.
    for (texel, (x, y)) in texels.iter().zip([(-0.5, 0.5), (0.5, 0.5), (-0.5, -0.5), (0.5, -0.5)]) {
        // Off the diagonal between the two triangles.
        let hit =
            built.intersect(&Ray::new(Vec3::new(x, y, 0.0), Vec3::NEG_Z)).expect("the square is in the way");
        let expected = Rgb::from(texel.map(srgb_to_linear_u8)) * (0.5 / PI as f32);
        let error = (hit.bsdf().eval(Vec3::Z) - expected).map(f32::abs).max_channel();
        assert!(error < 1e-6, "({x}, {y}): {:?}, expected {expected:?}", hit.bsdf().eval(Vec3::Z));
    }
    // Without texture coordinates, the value is that at (0, 0): the mean of all four texels, as the texture repeats.
    for triangle in &mut scene.meshes[0].triangles {
        triangle.uvs = None;
    }
    let built = Scene::new(&scene);
    let hit =
        built.intersect(&Ray::new(Vec3::new(0.7, 0.1, 0.0), Vec3::NEG_Z)).expect("the square is in the way");
    let mean =
        texels.iter().fold(Rgb::BLACK, |sum, texel| sum + 0.25 * Rgb::from(texel.map(srgb_to_linear_u8)));
    assert!((hit.bsdf().eval(Vec3::Z) - mean * (0.5 / PI as f32)).map(f32::abs).max_channel() < 1e-6);
}

#[test]
fn zero_bounces_show_emission_only() {
    let mut scene = empty();
    let square = quad(Vec3::new(-9.0, -9.0, -1.0), 18.0 * Vec3::X, 18.0 * Vec3::Y);
    add(&mut scene, &square, Material { emission: Rgb::new(1.0, 2.0, 3.0), ..diffuse(0.5) });
    scene.lights.push(LightDescription::Point { position: Vec3::ZERO, power: Rgb::gray(1e6) });
    for technique in Technique::ALL {
        let tracer = PathTracer::new(Settings { technique, max_bounces: 0 });
        let film = film(&tracer, &Scene::new(&scene), 1, &[0, 3], Streams::independent(SEED));
        assert!(film.pixels().iter().all(|pixel| pixel.mean() == Rgb::new(1.0, 2.0, 3.0)), "{technique}");
    }
}

#[test]
fn each_bounce_adds_a_term_of_the_geometric_series() {
    // In a uniformly emitting closed room each bounce adds ρ times the previous one, without noise for a diffuse BSDF.
    let mut scene = empty();
    let walls = room(Vec3::new(-1.0, -1.0, -2.0), Vec3::new(1.0, 1.0, 1.0));
    add(&mut scene, &walls, Material { emission: Rgb::gray(1.0), ..diffuse(0.5) });
    let scene = Scene::new(&scene);
    for (bounces, expected) in [(0, 1.0), (1, 1.5), (2, 1.75), (4, 1.9375)] {
        for pixel in film(&tracer(bounces), &scene, 1, &[0, 40], Streams::independent(SEED)).pixels() {
            assert!((pixel.mean().g - expected).abs() < 1e-5, "{bounces}: {:?}", pixel.mean());
        }
    }
}

#[test]
fn names_of_techniques_can_be_parsed() {
    for technique in Technique::ALL {
        assert_eq!(technique.name().parse(), Ok(technique));
    }
    assert!("path".parse::<Technique>().is_err());
}
