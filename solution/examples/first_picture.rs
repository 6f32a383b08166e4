//! Prints how long the window waits for a picture after the camera has moved: `cargo run --release -p solution --example
//! first_picture [SCENE.yml]`.
//!
//! Moves come when the picture before is refined, as with single keys, and 10 ms after each other, as with the mouse. The
//! time is that from the move to the picture of the new view; painting it takes some milliseconds more.

#[path = "../src/algorithms/render_pt.rs"]
#[allow(unreachable_pub)] // its items are used by the program it belongs to, not here
mod render_pt;

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::channel;
use std::time::{Duration, Instant};

use arty::cli::{Algorithm, DEFAULT_MAX_BOUNCES, image_size};
use arty::integrator::{Integrator, Settings, Technique};
use arty::scene::{Scene, file};
use arty_view::renderer::{News, Renderer, Setup};
use arty_view::view::{Balance, View};
use render_pt::PathTracer;

/// Number of moves of each kind.
const MOVES: usize = 40;

fn main() {
    let scene = std::env::args().nth(1).map_or_else(default_scene, PathBuf::from);
    let description = Arc::new(file::load(&scene).unwrap_or_else(|error| panic!("{error}")).description);
    let (width, height) = image_size(None, None, description.defaults);
    let built = Arc::new(Scene::new(&description));
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let camera = description.camera;
    let setup = Setup { description, width, height, seed: 0, samples: None, threads, reference: None };
    let max_bounces = setup.description.defaults.max_bounces.unwrap_or(DEFAULT_MAX_BOUNCES);
    let algorithm = Algorithm::PathTracer(Settings { technique: Technique::Mis, max_bounces });
    let mut view = View { camera, algorithm, against: None, balance: Balance::EqualSamples };
    let (sender, news) = channel();
    let renderer =
        Renderer::start(built, make, setup, view, move |it| drop(sender.send(it))).expect("it starts");
    println!("{}: {width} x {height} pixels, {threads} threads", scene.display());
    for (pause, name) in
        [(Duration::from_millis(400), "single moves"), (Duration::from_millis(10), "moves every 10 ms")]
    {
        let mut times: Vec<f64> = Vec::new();
        for _ in 0..MOVES {
            std::thread::sleep(pause);
            view.camera.eye.x += 1e-3;
            let start = Instant::now();
            renderer.show(view);
            while renderer.frame().is_none_or(|frame| frame.view != view) {
                match news.recv_timeout(Duration::from_secs(60)).expect("the renderer is alive") {
                    News::Panicked => panic!("the path tracer panicked"),
                    _ => continue,
                }
            }
            times.push(1e3 * start.elapsed().as_secs_f64());
        }
        times.sort_by(f64::total_cmp);
        let (median, last) = (times[times.len() / 2], times[times.len() - 1]);
        println!("{name:<18} median {median:.1} ms, longest {last:.1} ms of {MOVES}");
    }
}

fn default_scene() -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/cornell_box.yml"))
}

fn make(algorithm: Algorithm, _: &Scene) -> Box<dyn Integrator> {
    let Algorithm::PathTracer(settings) = algorithm else { unreachable!("only paths are traced here") };
    Box::new(PathTracer::new(settings))
}
