//! A machine that has no memory left ends some process, and not always that of whoever is to blame. That is believed when the
//! kernel says so: any other end is the submission's own.
#![cfg(target_os = "linux")]

use std::process::Command;
use std::time::Duration;

use arty::integrator::{Settings, Technique};
use harness::assignment::Assignment;
use harness::build::compile;
use harness::host_process::HostProcess;
use harness::job::JobError;
use harness::sandbox::Limits;
use harness::workspace::Workspace;
use host::protocol::RenderJob;
use verdict::check::Fault;

const ENDLESS: &str = "use arty::prelude::*;
pub struct PathTracer;
impl PathTracer { pub fn new(_: Settings) -> Self { Self } }
impl Integrator for PathTracer {
    fn radiance(&self, _: &Scene, _: Ray, _: &mut Sampler) -> Rgb { loop { std::hint::spin_loop() } }
}
";

/// The processes that this one has started.
fn children() -> Vec<u32> {
    let own = std::process::id().to_string();
    let processes = std::fs::read_dir("/proc").expect("it is there").flatten();
    processes
        .filter_map(|entry| entry.file_name().to_str()?.parse().ok())
        .filter(|process: &u32| {
            let stat = std::fs::read_to_string(format!("/proc/{process}/stat")).unwrap_or_default();
            // The name, in parentheses, may hold anything; the parent is the second field after it.
            stat.rsplit(')').next().and_then(|rest| rest.split(' ').nth(2)) == Some(own.as_str())
        })
        .collect()
}

#[test]
fn a_process_that_is_ended_is_at_fault_unless_the_kernel_had_no_memory_left() {
    let workspace = Workspace::find().expect("the tests run inside the checkout");
    let framework = Assignment::open(&workspace, "05-nee-mis")
        .and_then(|it| it.framework(&workspace))
        .expect("the framework builds");
    let program = compile(&framework, ENDLESS, &Limits::default()).expect("rustc runs").expect("it compiles");
    let scene =
        arty::scene::file::load(&workspace.scene_file("point_plane")).expect("it is there").description;
    let mut process = HostProcess::start(&program, 1).expect("the program starts");
    let scene = process.load(&scene).expect("the scene loads");
    let settings = Settings { technique: Technique::Nee, max_bounces: 1 };
    let job = RenderJob::new(scene, settings, [16, 16], vec![1], 16);
    let [child] = children()[..] else { panic!("{:?}", children()) };
    let killer = std::thread::spawn(move || {
        std::thread::sleep(Duration::from_millis(300));
        let kill = Command::new("bash").args(["-c", &format!("kill -KILL {child}")]).status();
        assert!(kill.expect("bash starts").success());
    });
    let outcome = process.render(&job);
    killer.join().expect("it was killed");
    assert!(
        matches!(&outcome, Err(JobError::Submission(Fault::Crash(how))) if how.contains("signal: 9")),
        "{outcome:?}"
    );
}
