//! Rendering in passes, until a limit is reached or an interruption.

use std::fmt;
use std::panic::{self, AssertUnwindSafe};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use super::exit::Failure;
use super::numbers::{counted, speed};
use super::passes::Passes;
use super::plan::Plan;
use super::progress::State;
use crate::film::Film;
use crate::integrator::Integrator;
use crate::render::render;
use crate::scene::Scene;

/// A finished or interrupted rendering.
#[derive(Debug)]
pub(super) struct Rendering {
    pub(super) film: Film,
    /// Wall-clock time.
    pub(super) elapsed: Duration,
    /// True if it was interrupted: then some pixels may have more samples than others.
    pub(super) interrupted: bool,
}

/// From here on, only the first panic of this process is printed: the same line often panics once per pixel.
pub(super) fn print_first_panic_only() {
    static IS_PRINTED: AtomicBool = AtomicBool::new(false);
    let usual = panic::take_hook();
    panic::set_hook(Box::new(move |info| {
        if !IS_PRINTED.swap(true, Ordering::Relaxed) {
            usual(info);
        }
    }));
}

/// Renders a scene. After each pass, `watch` is called with the film and the state.
///
/// # Errors
///
/// If the threads cannot be started, or the integrator panics.
pub(super) fn render_scene(
    integrator: &dyn Integrator,
    scene: &Scene,
    plan: &Plan,
    stop: &AtomicBool,
    mut watch: impl FnMut(&Film, &State),
) -> Result<Rendering, Failure> {
    // Zero threads: one per processor.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(plan.threads.unwrap_or(0)).build()?;
    let mut film = Film::new(plan.width, plan.height);
    let mut passes = Passes::new(plan.limits);
    let start = Instant::now();
    let mut interrupted = false;
    while let Some(pass) = passes.next(start.elapsed()) {
        let pass_start = Instant::now();
        let mut take = || {
            pool.install(|| render(integrator, scene, &mut film, pass.clone(), plan.streams, stop));
        };
        // After a panic the film is dropped, so its state does not matter.
        panic::catch_unwind(AssertUnwindSafe(&mut take)).map_err(|_| Failure::Panic)?;
        interrupted = stop.load(Ordering::Relaxed);
        if interrupted {
            break;
        }
        passes.finish(pass, pass_start.elapsed());
        watch(&film, &State::new(&passes, start.elapsed(), plan));
    }
    Ok(Rendering { film, elapsed: start.elapsed(), interrupted })
}

impl fmt::Display for Rendering {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let counts = || self.film.pixels().iter().map(|pixel| pixel.count);
        let (min, max, all) = (self.film.samples(), counts().max().unwrap_or(0), counts().sum::<u64>());
        if self.interrupted {
            write!(f, "interrupted: ")?;
        }
        if min < max {
            write!(f, "{min} to ")?;
        }
        let seconds = self.elapsed.as_secs_f64();
        let samples = counted(max, "sample");
        write!(f, "{samples} per pixel in {seconds:.2} s, {}", speed(all as f64 / seconds.max(1e-9)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Rgb, Vec3};
    use crate::ray::Ray;
    use crate::sampler::{Sampler, Streams};
    use crate::scene::{CameraDescription, Defaults, SceneDescription};

    /// Returns random numbers, and triggers an event at the call number `at`.
    struct Noise<'a> {
        calls: std::sync::atomic::AtomicU64,
        at: u64,
        event: &'a (dyn Fn() + Sync),
    }

    impl<'a> Noise<'a> {
        fn new(at: u64, event: &'a (dyn Fn() + Sync)) -> Self {
            Self { calls: 0.into(), at, event }
        }
    }

    impl Integrator for Noise<'_> {
        fn radiance(&self, _: &Scene, _: Ray, sampler: &mut Sampler) -> Rgb {
            if self.calls.fetch_add(1, Ordering::Relaxed) + 1 == self.at {
                (self.event)();
            }
            Rgb::gray(sampler.next_1d())
        }
    }

    fn empty_scene() -> Scene {
        let camera = CameraDescription { eye: Vec3::ZERO, center: Vec3::Z, up: Vec3::Y, fov: 60.0 };
        Scene::new(&SceneDescription {
            camera,
            meshes: vec![],
            materials: vec![],
            textures: vec![],
            lights: vec![],
            defaults: Defaults::default(),
            environment: None,
        })
    }

    fn plan(options: &str) -> Plan {
        let line = format!("arty x.yml --width=8 --height=6 --threads=2 {options}");
        let args = super::super::args::Args::read(line.split_whitespace().map(Into::into));
        Plan::new(&args.expect("a valid command line"), Defaults::default()).expect("small")
    }

    #[test]
    fn passes_do_not_change_the_image() {
        let (scene, plan, stop) = (empty_scene(), plan("--samples=37 --seed=5"), AtomicBool::new(false));
        let noise = Noise::new(0, &|| ());
        let mut watched = Vec::new();
        let in_passes = render_scene(&noise, &scene, &plan, &stop, |film, _| watched.push(film.samples()));
        let in_passes = in_passes.expect("it works");
        let mut at_once = Film::new(8, 6);
        render(&noise, &scene, &mut at_once, 0..37, Streams::independent(5), &stop);
        assert_eq!(in_passes.film.pixels(), at_once.pixels());
        assert!(watched.len() > 1 && watched.last() == Some(&37), "there were passes: {watched:?}");
        assert!(!in_passes.interrupted);
    }

    #[test]
    fn an_interruption_keeps_the_samples_so_far() {
        let (scene, plan, stop) = (empty_scene(), plan("--time=3600"), AtomicBool::new(false));
        let raise = || stop.store(true, Ordering::Relaxed);
        // The first pass has 48 samples, so this is in a later one.
        let rendering = render_scene(&Noise::new(100, &raise), &scene, &plan, &stop, |_, _| ());
        let rendering = rendering.expect("an interruption is not a failure");
        assert!(rendering.interrupted && rendering.film.samples() >= 1);
        assert!(rendering.to_string().starts_with("interrupted: "), "{rendering}");
    }

    #[test]
    fn a_panic_of_the_algorithm_has_its_own_exit_status() {
        let (scene, plan, stop) = (empty_scene(), plan("--samples=9"), AtomicBool::new(false));
        let noise = Noise::new(100, &|| panic!("on purpose"));
        let failure = render_scene(&noise, &scene, &plan, &stop, |_, _| ()).expect_err("it panicked");
        assert!(matches!(failure, Failure::Panic));
        assert_eq!(failure.exit() as u8, 3);
    }
}
