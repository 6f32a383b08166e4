//! What a submission could find if it had the memory of its process to itself: the scene, and nothing that it is
//! compared with.
#![cfg(target_os = "linux")]

use std::fs::File;
use std::os::unix::fs::FileExt;

use arty::integrator::{Settings, Technique};
use harness::assignment::Assignment;
use harness::build::compile;
use harness::host_process::HostProcess;
use harness::sandbox::Limits;
use harness::workspace::Workspace;
use host::protocol::RenderJob;
use judge::grade::load_scene;

/// The only child of this process.
fn child() -> u32 {
    let own = std::process::id().to_string();
    let is_child = |pid: &u32| {
        let status = std::fs::read_to_string(format!("/proc/{pid}/status")).unwrap_or_default();
        status.lines().any(|line| line.strip_prefix("PPid:").is_some_and(|parent| parent.trim() == own))
    };
    let pids = std::fs::read_dir("/proc")
        .expect("it can be listed")
        .filter_map(|entry| entry.expect("it can be read").file_name().to_string_lossy().parse().ok());
    let children: Vec<u32> = pids.filter(is_child).collect();
    assert_eq!(children.len(), 1, "the submission is the only child");
    children[0]
}

/// Everything that a process can read in its memory; `None` if the system does not let anybody else read it.
fn memory(pid: u32) -> Option<Vec<u8>> {
    let memory = File::open(format!("/proc/{pid}/mem")).ok()?;
    let maps = std::fs::read_to_string(format!("/proc/{pid}/maps")).ok()?;
    let mut all = Vec::new();
    for line in maps.lines().filter(|line| line.split(' ').nth(1).is_some_and(|mode| mode.starts_with('r'))) {
        let (low, high) = line.split(' ').next()?.split_once('-')?;
        let (low, high) = (u64::from_str_radix(low, 16).ok()?, u64::from_str_radix(high, 16).ok()?);
        let mut part = vec![0; usize::try_from(high - low).ok()?];
        // Some mappings of the kernel's own cannot be read.
        if memory.read_exact_at(&mut part, low).is_ok() {
            all.append(&mut part);
        }
    }
    Some(all)
}

fn holds(memory: &[u8], bytes: &[u8]) -> bool {
    memchr::memmem::find(memory, bytes).is_some()
}

#[test]
fn the_process_of_a_submission_holds_the_scene_and_nothing_that_it_is_compared_with() {
    let workspace = Workspace::find().expect("the tests run inside the checkout");
    let assignment = Assignment::open(&workspace, "05-nee-mis").expect("it is sound");
    let framework = assignment.framework(&workspace).expect("the framework builds");
    let source = assignment.solution().expect("the solution is there");
    let program = compile(&framework, &source, &Limits::default()).expect("rustc runs").expect("it compiles");

    let name = "cornell_box_point";
    let known = load_scene(&workspace, name).expect("the scene and its reference are there");
    let mut process = HostProcess::start(&program, 2).expect("it starts");
    let scene = process.load(&known.description).expect("it loads");
    let settings = Settings { technique: Technique::Nee, max_bounces: 1 };
    let job = RenderJob::new(scene, settings, [24, 24], vec![7], 4);
    process.render(&job).expect("it renders");

    let Some(memory) = memory(child()) else {
        eprintln!("left out: this system does not let a parent read its child's memory");
        return;
    };
    let arty::scene::LightDescription::Point { position, .. } = known.description.lights[0] else {
        panic!("it has a point light")
    };
    let position: Vec<u8> = position.to_array().iter().flat_map(|value| value.to_ne_bytes()).collect();
    assert!(holds(&memory, &position), "the search finds what is there");

    let single = |values: &[f64]| values.iter().flat_map(|&v| (v as f32).to_ne_bytes()).collect::<Vec<u8>>();
    let double = |values: &[f64]| values.iter().flat_map(|v| v.to_ne_bytes()).collect::<Vec<u8>>();
    let lit = |pixel: &&[f64; 3]| pixel.iter().all(|&value| value > 0.0);
    for (view, reference) in &known.reference.views {
        let deviations = reference.techniques.values().flat_map(|moments| &moments.deviation);
        for pixel in reference.mean.iter().chain(&reference.variance_of_mean).chain(deviations).filter(lit) {
            assert!(
                !holds(&memory, &single(pixel)) && !holds(&memory, &double(pixel)),
                "{view:?}: {pixel:?}"
            );
        }
    }
    let checkout = workspace.root().display().to_string();
    let environment = std::env::var("PATH").expect("the environment has a PATH");
    for secret in [environment.as_str(), &checkout, name, "required: true", "references/"] {
        assert!(!holds(&memory, secret.as_bytes()), "{secret}");
    }
}
