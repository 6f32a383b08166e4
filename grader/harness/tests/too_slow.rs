//! Submissions that take too long. Alone in this file: other tests at the same time would take their time on a processor.
#![cfg(target_os = "linux")]

use std::time::Duration;

use arty::integrator::{Settings, Technique};
use harness::assignment::Assignment;
use harness::build::compile;
use harness::host_process::HostProcess;
use harness::job::apart;
use harness::sandbox::Limits;
use harness::workspace::Workspace;
use host::protocol::RenderJob;
use verdict::check::Fault;

/// Source of a function that computes for so many milliseconds of processor time. What the processor does in a
/// millisecond is the best of many tries, so that other programs on it do not matter.
const WORK: &str = "
    static PER_MILLISECOND: std::sync::LazyLock<f64> = std::sync::LazyLock::new(|| {
        let time = |_| {
            let start = std::time::Instant::now();
            steps(10_000);
            start.elapsed().as_secs_f64()
        };
        10.0 / (0..200).map(time).fold(f64::INFINITY, f64::min)
    });
    fn steps(count: u64) {
        for step in 0..count {
            std::hint::black_box(step);
        }
    }
    fn work(milliseconds: u64) {
        steps((milliseconds as f64 * *PER_MILLISECOND) as u64);
    }
";

#[test]
fn nobody_waits_to_the_end_for_a_submission_that_is_too_slow_by_far_unless_it_had_no_time() {
    let workspace = Workspace::find().expect("the tests run inside the checkout");
    let framework = Assignment::open(&workspace, "05-nee-mis")
        .and_then(|it| it.framework(&workspace))
        .expect("the framework builds");
    let scene = arty::scene::file::load(&workspace.scene_file("point_plane")).expect("it is there");
    // 16 batches of one pixel, on one thread, within 3 s: each may take about 190 ms, and the first two 500 together.
    let render = |sample: &str| {
        let source = format!(
            "use arty::prelude::*;
            {WORK}
            pub struct PathTracer;
            impl PathTracer {{ pub fn new(_: Settings) -> Self {{ Self }} }}
            impl Integrator for PathTracer {{
                fn radiance(&self, scene: &Scene, ray: Ray, sampler: &mut Sampler) -> Rgb {{
                    let _ = scene.intersect(&ray);
                    {sample};
                    Rgb::WHITE * sampler.next_1d()
                }}
            }}"
        );
        let (job_time, waiting) = (Duration::from_secs(3), Duration::from_secs(6));
        let limits = Limits { job_time, waiting, ..Limits::default() };
        let program = compile(&framework, &source, &limits).expect("rustc runs").expect("it compiles");
        let process = HostProcess::start(&program, 1).expect("the program starts");
        let mut process = process.within(limits.job_time);
        let scene = process.load(&scene.description).expect("the scene loads");
        let settings = Settings { technique: Technique::Nee, max_bounces: 1 };
        let job = |seeds: std::ops::Range<u64>| RenderJob::new(scene, settings, [1, 1], seeds.collect(), 1);
        [0..16, 5..6, 16..32].map(|seeds| apart(process.render(&job(seeds))).expect("the pipe holds"))
    };
    let work = |milliseconds: u64| format!("work({milliseconds})");
    let [whole, sixth, _] = render(&work(20));
    let (whole, sixth) = (whole.expect("it is fast enough"), sixth.expect("it still is"));
    // Rendering in two parts changes nothing.
    assert_eq!((whole.batches.len(), &whole.batches[5]), (16, &sixth.batches[0]));

    let too_slow = Err(Fault::TooSlow(0.5));
    // So long that it is found even if the machine gives it a seventh of a core.
    assert_eq!(render(&work(2000))[0], too_slow);
    // Slower from the 18th sample on: that is no longer tried first, since it went well before.
    let later = format!(
        "static COUNT: std::sync::atomic::AtomicU32 = std::sync::atomic::AtomicU32::new(0);
        if COUNT.fetch_add(1, std::sync::atomic::Ordering::Relaxed) >= 17 {{ {} }}",
        work(400)
    );
    assert_eq!(render(&later)[2], Err(Fault::Timeout(3.0)));
    // Waiting has limits of its own, of which no part of a job has less.
    let asleep = "std::thread::sleep(std::time::Duration::from_millis(600))";
    assert_eq!(render(asleep)[0], Err(Fault::Waiting(3.0)));
    let awake_later =
        format!("static ONCE: std::sync::Once = std::sync::Once::new(); ONCE.call_once(|| {asleep})");
    assert!(render(&awake_later).iter().all(Result::is_ok));
    // No job takes longer than it may; all together do.
    assert_eq!(render(&work(100))[2], Err(Fault::Timeout(3.0)));
}
