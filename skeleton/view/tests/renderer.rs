//! The thread that renders, with algorithms made for these tests.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

use arty::camera::CameraDescription;
use arty::cli::{Algorithm, DebugView};
use arty::film::{Film, Pixel};
use arty::integrator::{Integrator, Settings, Technique};
use arty::math::{Rgb, Vec3};
use arty::prelude::{Ray, Sampler};
use arty::render::render;
use arty::sampler::Streams;
use arty::scene::{Defaults, Scene, SceneDescription};
use arty_view::Save;
use arty_view::look::{Look, ToneMap};
use arty_view::renderer::{Frame, News, Renderer, Setup};
use arty_view::view::{Against, Balance, View};

const SIZE: (u32, u32) = (61, 37);

/// Direction and a random number; panics if asked for normals. With `mis` it takes a microsecond per bounce.
struct Noise(Algorithm);

impl Integrator for Noise {
    fn radiance(&self, _: &Scene, ray: Ray, sampler: &mut Sampler) -> Rgb {
        match self.0 {
            Algorithm::Debug(_) => panic!("on purpose"),
            Algorithm::PathTracer(Settings { technique: Technique::Mis, max_bounces }) => {
                let start = Instant::now();
                while start.elapsed() < Duration::from_micros(max_bounces.into()) {}
            }
            Algorithm::PathTracer(_) => {}
        }
        Rgb::new(ray.direction.x.abs(), ray.direction.y.abs(), sampler.next_1d())
    }
}

fn description() -> SceneDescription {
    let camera = CameraDescription { eye: Vec3::Z, center: Vec3::ZERO, up: Vec3::Y, fov: 60.0 };
    let (meshes, materials, textures, lights) = (vec![], vec![], vec![], vec![]);
    let defaults = Defaults::default();
    SceneDescription { camera, meshes, materials, textures, lights, defaults, environment: None }
}

fn traced(technique: Technique) -> Algorithm {
    Algorithm::PathTracer(Settings { technique, max_bounces: 20 })
}

fn view(algorithm: Algorithm) -> View {
    View { camera: description().camera, algorithm, against: None, balance: Balance::EqualSamples }
}

fn start(view: View, samples: Option<u64>) -> (Renderer, Receiver<News>) {
    let (width, height) = SIZE;
    let description = Arc::new(description());
    let scene = Arc::new(Scene::new(&description));
    let setup = Setup { description, width, height, seed: 5, samples, threads: 2, reference: None };
    let (sender, news) = channel();
    let make = |algorithm, _: &Scene| Box::new(Noise(algorithm)) as Box<dyn Integrator>;
    let renderer = Renderer::start(scene, make, setup, view, move |news| drop(sender.send(news)));
    (renderer.expect("it starts"), news)
}

/// Waits for a frame with this property.
fn wait(renderer: &Renderer, news: &Receiver<News>, is_fine: impl Fn(&Frame) -> bool) -> Arc<Frame> {
    let start = Instant::now();
    while start.elapsed() < Duration::from_secs(60) {
        news.recv_timeout(Duration::from_secs(60)).expect("the renderer is alive");
        if let Some(frame) = renderer.frame().filter(|frame| is_fine(frame)) {
            return frame;
        }
    }
    panic!("no such frame after a minute");
}

#[test]
fn the_picture_is_the_one_that_the_command_line_renders() {
    let (renderer, news) = start(view(traced(Technique::Nee)), Some(23));
    let frame = wait(&renderer, &news, |frame| frame.pictures[0].samples == 23);
    let mut film = Film::new(SIZE.0, SIZE.1);
    let scene = Scene::new(&description());
    render(
        &Noise(traced(Technique::Nee)),
        &scene,
        &mut film,
        0..23,
        Streams::independent(5),
        &AtomicBool::new(false),
    );
    let expected: Vec<Rgb> = film.pixels().iter().map(Pixel::mean).collect();
    assert_eq!(frame.pictures[0].image.pixels(), expected);
}

#[test]
fn while_the_camera_moves_all_the_time_there_are_pictures() {
    // Even a coarse picture takes longer than the time between two moves.
    let settings = Settings { technique: Technique::Mis, max_bounces: 1000 };
    let mut moving = view(Algorithm::PathTracer(settings));
    let (renderer, news) = start(moving, None);
    let mut shown = 0;
    for step in 0..300 {
        moving.camera.eye.x = step as f32 * 1e-3;
        renderer.show(moving);
        std::thread::sleep(Duration::from_millis(2));
        shown += news.try_iter().count();
    }
    assert!(shown >= 5, "{shown} pictures in 300 moves");
    wait(&renderer, &news, |frame| frame.view == moving && frame.pictures[0].samples > 0);
}

#[test]
fn two_pictures_have_equal_samples_or_equal_time() {
    let right = Some(Against::Algorithm(traced(Technique::Mis)));
    let samples = View { against: right, ..view(traced(Technique::Nee)) };
    let (renderer, news) = start(samples, None);
    let frame = wait(&renderer, &news, |frame| frame.pictures[0].samples > 3);
    let [fast, slow] = &frame.pictures[..] else { panic!("two pictures") };
    assert_eq!(fast.samples, slow.samples);
    assert!(slow.time > fast.time, "{:?}, {:?}", slow.time, fast.time);
    renderer.show(View { balance: Balance::EqualTime, ..samples });
    // A single pass may take long on a busy machine, so that the times get alike only after some of them.
    let is_balanced = |frame: &Frame| {
        let [fast, slow] = &frame.pictures[..] else { return false };
        let ratio = fast.time.as_secs_f64() / slow.time.as_secs_f64();
        frame.view.balance == Balance::EqualTime
            && (0.5..2.0).contains(&ratio)
            && fast.samples > 2 * slow.samples
    };
    wait(&renderer, &news, is_balanced);
}

#[test]
fn a_panic_ends_the_picture_and_another_view_goes_on() {
    let (renderer, news) = start(view(Algorithm::Debug(DebugView::Normals)), None);
    let first = news.recv_timeout(Duration::from_secs(60));
    assert!(matches!(first, Ok(News::Panicked)), "{first:?}");
    renderer.show(view(traced(Technique::Nee)));
    wait(&renderer, &news, |frame| frame.pictures[0].samples > 0);
}

#[test]
fn a_pause_gives_the_first_sample_of_a_new_view_and_no_more() {
    let (renderer, news) = start(view(traced(Technique::Nee)), None);
    renderer.pause(true);
    let mut moved = view(traced(Technique::Nee));
    moved.camera.fov = 30.0;
    renderer.show(moved);
    wait(&renderer, &news, |frame| frame.view == moved && frame.pictures[0].samples > 0);
    std::thread::sleep(Duration::from_millis(300));
    let samples = renderer.frame().map(|frame| frame.pictures[0].samples);
    assert_eq!(samples, Some(1));
    renderer.pause(false);
    wait(&renderer, &news, |frame| frame.pictures[0].samples > 1);
}

#[test]
fn the_picture_is_saved_as_shown_and_as_linear_data() {
    let folder = tempfile::tempdir().expect("a folder");
    let (renderer, news) = start(view(traced(Technique::Nee)), Some(4));
    let frame = wait(&renderer, &news, |frame| frame.pictures[0].samples == 4);
    let look = Look { exposure: 0.0, tone_map: ToneMap::Reinhard };
    renderer.save(Save { stem: folder.path().join("scene"), look });
    let saved = loop {
        if let News::Saved(saved) = news.recv_timeout(Duration::from_secs(60)).expect("an answer") {
            break saved.expect("it is saved");
        }
    };
    assert!(saved.contains("scene-nee.png") && saved.contains("scene-nee.exr"), "{saved}");
    let file =
        arty::image::exr::ExrFile::read(&folder.path().join("scene-nee.exr")).expect("an OpenEXR file");
    assert_eq!(file.layer("").as_ref(), Some(&frame.pictures[0].image));
    assert_eq!(file.metadata.get("arty:samples_per_pixel").map(String::as_str), Some("4"));
    assert!(folder.path().join("scene-nee.png").is_file());
}
