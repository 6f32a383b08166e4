//! Rays and shadow rays per second, on one thread.
//!
//! `cargo bench -p arty --bench traversal`. The rays are those of a path tracer in several scenes: camera rays, bounces,
//! and shadow rays to lights. Throughput is in elements per second; elements are rays. A hit includes its point and normals.

use std::hint::black_box;
use std::path::Path;

use arty::prelude::{Hit, Ray, Sampler, Scene, Vec3};
use arty::scene::file;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};

/// Number of rays of each kind.
const RAYS: usize = 1 << 14;

/// Maximum number of bounces.
const MAX_BOUNCES: usize = 8;

/// Width and height of the image for camera rays.
const SIZE: (u32, u32) = (128, 128);

#[derive(Default)]
struct Rays<'a> {
    primary: Vec<Ray>,
    bounces: Vec<Ray>,
    shadow: Vec<(Hit<'a>, Vec3)>,
}

impl<'a> Rays<'a> {
    /// The rays of as many paths as needed; `None` if the scene has too few rays of a kind.
    fn of(scene: &'a Scene) -> Option<Self> {
        let camera = scene.camera(SIZE.0, SIZE.1);
        let mut rays = Self::default();
        for path in 0..16 * RAYS as u64 {
            if rays.bounces.len() >= RAYS && rays.shadow.len() >= RAYS && rays.primary.len() >= RAYS {
                rays.bounces.truncate(RAYS);
                rays.shadow.truncate(RAYS);
                return Some(rays);
            }
            // Random pixels are harder than neighbouring ones, as in an image.
            let mut sampler = Sampler::new(1, SIZE, path);
            let (u, v) = sampler.next_2d();
            let (column, row) = (u * SIZE.0 as f32, v * SIZE.1 as f32);
            let mut ray = camera.ray(column as u32, row as u32, sampler.next_2d());
            if rays.primary.len() < RAYS {
                rays.primary.push(ray);
            }
            for _ in 0..MAX_BOUNCES {
                let Some(hit) = scene.intersect(&ray) else { break };
                let pick = (sampler.next_1d() * scene.lights().len() as f32) as usize;
                let light = scene.lights().get(pick);
                if let Some(sample) = light.and_then(|light| light.sample_direct(hit.point, &mut sampler)) {
                    rays.shadow.push((hit, sample.point));
                }
                let Some(sample) = hit.bsdf().sample(&mut sampler) else { break };
                ray = hit.spawn(sample.wi);
                rays.bounces.push(ray);
            }
        }
        None
    }
}

fn hits(scene: &Scene, rays: &[Ray]) -> usize {
    rays.iter().filter(|ray| scene.intersect(ray).is_some()).count()
}

fn blocked(scene: &Scene, rays: &[(Hit<'_>, Vec3)]) -> usize {
    rays.iter().filter(|(hit, target)| scene.occluded(hit, *target)).count()
}

fn traversal(criterion: &mut Criterion) {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes");
    for name in ["cornell_box", "mesh"] {
        let loaded =
            file::load(&scenes.join(name).with_extension("yml")).expect("the scene is in the collection");
        let scene = Scene::new(&loaded.description);
        let rays = Rays::of(&scene).expect("the scene has lights, and most rays hit something");
        let mut group = criterion.benchmark_group(name);
        group.throughput(Throughput::Elements(RAYS as u64));
        group.bench_function("primary", |b| b.iter(|| hits(&scene, black_box(&rays.primary))));
        group.bench_function("bounce", |b| b.iter(|| hits(&scene, black_box(&rays.bounces))));
        group.bench_function("shadow", |b| b.iter(|| blocked(&scene, black_box(&rays.shadow))));
        group.finish();
    }
}

criterion_group!(benches, traversal);
criterion_main!(benches);
