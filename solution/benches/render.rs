//! Samples per second of the solution, by scene and technique on one thread, and the speedup of two threads.
//!
//! `cargo bench -p solution`. Throughput is in elements per second; elements are pixel samples.

#[path = "../src/algorithms/render_pt.rs"]
#[allow(unreachable_pub)] // its items are used by the program it belongs to, not here
mod render_pt;

use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use arty::film::Film;
use arty::prelude::{Scene, Settings, Technique};
use arty::render::render;
use arty::sampler::Streams;
use arty::scene::file;
use criterion::{Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use rayon::{ThreadPool, ThreadPoolBuilder};
use render_pt::PathTracer;

const WIDTH: u32 = 128;
const HEIGHT: u32 = 103;
const MAX_BOUNCES: u32 = 8;

/// Interleaved rounds of one and two threads.
const ROUNDS: usize = 9;

fn load(name: &str) -> Scene {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes");
    let loaded =
        file::load(&scenes.join(name).with_extension("yml")).expect("the scene is in the collection");
    Scene::new(&loaded.description)
}

fn pool(threads: usize) -> ThreadPool {
    ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be started")
}

fn image(pool: &ThreadPool, scene: &Scene, technique: Technique, samples: u64) -> Film {
    let mut film = Film::new(WIDTH, HEIGHT);
    let tracer = PathTracer::new(Settings { technique, max_bounces: MAX_BOUNCES });
    pool.install(|| {
        render(&tracer, scene, &mut film, 0..samples, Streams::independent(1), &AtomicBool::new(false))
    });
    film
}

fn samples(criterion: &mut Criterion) {
    let one = pool(1);
    for name in ["cornell_box", "cornell_box_glossy", "veach_mis"] {
        let scene = load(name);
        let mut group = criterion.benchmark_group(name);
        group.sample_size(20).sampling_mode(SamplingMode::Flat);
        group.throughput(Throughput::Elements(u64::from(WIDTH * HEIGHT)));
        for technique in Technique::ALL {
            group.bench_function(technique.name(), |b| b.iter(|| image(&one, &scene, technique, 1)));
        }
        group.finish();
    }
}

/// Prints the speedup of two threads over one. The measurements are interleaved, so that other load affects both.
fn scaling(_: &mut Criterion) {
    let scene = load("cornell_box");
    let (one, two) = (pool(1), pool(2));
    let seconds = |pool: &ThreadPool| {
        let start = Instant::now();
        image(pool, &scene, Technique::Mis, 16);
        start.elapsed().as_secs_f64()
    };
    let mut ratios: Vec<f64> = (0..ROUNDS).map(|_| seconds(&one) / seconds(&two)).collect();
    ratios.sort_by(f64::total_cmp);
    println!("speedup of two threads: {:.2}", ratios[ROUNDS / 2]);
}

criterion_group!(benches, samples, scaling);
criterion_main!(benches);
