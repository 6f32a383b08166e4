//! How many samples a second the filled-in path tracer takes: by scene and technique on one thread, and how much
//! faster two threads are.
//!
//! `cargo bench -p solution`. Throughput is in elements, that is samples of pixels, a second.

#[path = "../src/algorithms/render_pt.rs"]
#[allow(unreachable_pub)] // what it defines is used by a program there, and by nobody here
mod render_pt;

use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use arty::film::Film;
use arty::prelude::{Scene, Settings, Technique};
use arty::render::render;
use arty::scene::file;
use criterion::{Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use rayon::{ThreadPool, ThreadPoolBuilder};
use render_pt::PathTracer;

const WIDTH: u32 = 128;
const HEIGHT: u32 = 103;
const MAX_BOUNCES: u32 = 8;

/// Rounds of one thread against two, in turns.
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
    pool.install(|| render(&tracer, scene, &mut film, 0..samples, 1, &AtomicBool::new(false)));
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

/// Prints the ratio of the times that one thread and two take. It is taken within one run and in turns, so that
/// whatever else the machine does slows down both.
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
    println!("two threads are {:.2} times as fast as one", ratios[ROUNDS / 2]);
}

criterion_group!(benches, samples, scaling);
criterion_main!(benches);
