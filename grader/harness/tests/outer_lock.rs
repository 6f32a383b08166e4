//! What confines a submission from its first instruction, tested by itself: sources and programs are not inspected here, so
//! that code of a submission does run before `main`.
#![cfg(all(target_os = "linux", target_arch = "x86_64"))]

use std::net::TcpListener;
use std::os::unix::fs::MetadataExt;

use arty::integrator::{Settings, Technique};
use arty::scene::SceneDescription;
use harness::assignment::Assignment;
use harness::build::{Framework, SubmissionProgram, compile, differences};
use harness::host_process::HostProcess;
use harness::job::apart;
use harness::sandbox::{Layers, Level, Limits, Machine};
use harness::workspace::Workspace;
use host::protocol::RenderJob;
use verdict::check::Fault;

struct Here {
    workspace: Workspace,
    framework: Framework,
    scene: SceneDescription,
}

impl Here {
    /// `None` where this machine has no sandbox.
    fn new() -> Option<Self> {
        if Level::of(Machine::here().layers()) < Level::Medium {
            eprintln!("left out: this machine has no sandbox; see `grader doctor`");
            return None;
        }
        let workspace = Workspace::find().expect("the tests run inside the checkout");
        let framework = Assignment::open(&workspace, "05-nee-mis")
            .and_then(|it| it.framework(&workspace))
            .expect("the framework builds");
        let scene =
            arty::scene::file::load(&workspace.scene_file("point_plane")).expect("it is there").description;
        Some(Self { workspace, framework, scene })
    }

    /// Compiles a source without any inspection.
    fn compile(&self, source: &str) -> SubmissionProgram {
        let limits = Limits { inspect: false, ..Limits::default() };
        compile(&self.framework, source, &limits).expect("rustc runs").expect("it compiles")
    }

    /// What becomes of a job, and how the process was confined.
    fn run(&self, program: &SubmissionProgram) -> (Option<Fault>, Layers) {
        let mut process = HostProcess::start(program, 1).expect("no submission makes the harness fail");
        let layers = process.layers();
        let settings = Settings { technique: Technique::Nee, max_bounces: 1 };
        let job = RenderJob::new(0, settings, [4, 4], vec![1], 1);
        let outcome = process.load(&self.scene).and_then(|_| process.render(&job));
        (apart(outcome).expect("no submission makes the harness fail").err(), layers)
    }
}

/// A submission that runs this before `main`.
fn early(body: &str) -> String {
    with_assembler(
        "\".pushsection .init_array, \\\"aw\\\"\", \".balign 8\", \".quad {first}\", \".popsection\", \"ret\", first = sym first",
        body,
    )
}

/// A submission with this assembler in a naked function, and this in a function `first`.
fn with_assembler(assembler: &str, first: &str) -> String {
    format!(
        "use arty::prelude::*;
extern \"C\" fn first() {{ {first} }}
#[unsafe(naked)]
extern \"C\" fn place() {{ core::arch::naked_asm!({assembler}) }}
extern \"C\" fn other() {{ std::hint::black_box(first as extern \"C\" fn()); }}
pub struct PathTracer;
impl PathTracer {{
    pub fn new(_: Settings) -> Self {{
        std::hint::black_box([place as extern \"C\" fn(), other]);
        Self
    }}
}}
impl Integrator for PathTracer {{
    fn radiance(&self, _: &Scene, _: Ray, _: &mut Sampler) -> Rgb {{ Rgb::BLACK }}
}}
"
    )
}

#[test]
fn code_before_main_reads_starts_and_reaches_nothing() {
    let Some(here) = Here::new() else { return };
    let listener = TcpListener::bind("127.0.0.1:0").expect("there is a port");
    let port = listener.local_addr().expect("it is bound").port().to_string();
    let file = here.workspace.root().join("grader/hostile/naked_before_main.rs");
    let source = std::fs::read_to_string(file).expect("it is there");
    let root = here.workspace.root().display().to_string();
    let grader = std::process::id().to_string();
    let source = source.replace("@ROOT@", &root).replace("@PORT@", &port).replace("@GRADER@", &grader);
    let (fault, layers) = here.run(&here.compile(&source));
    let Some(Fault::Panic(said)) = &fault else { panic!("{fault:?}") };
    assert!(said.contains("it ran before main, and reached nothing"), "{said}");
    listener.set_nonblocking(true).expect("it can be set");
    assert!(listener.accept().is_err(), "it has connected");
    assert!(!std::path::Path::new("/tmp/arty-owned").exists());
    // The level is that of any other submission.
    assert_eq!(layers, Machine::here().layers());
    let (fault, honest) = here.run(&here.compile(&with_assembler("\"ret\"", "")));
    assert_eq!((fault, honest), (None, layers));
}

#[test]
fn the_loader_loads_nothing_else_and_the_program_of_another_submission_is_out_of_reach() {
    let Some(here) = Here::new() else { return };
    let neighbour = here.compile(&with_assembler("\"ret\"", ""));
    let other = neighbour.executable.display().to_string();
    for program in ["/bin/echo", "/bin/sh", &other] {
        let source = early(&format!(
            "use std::os::unix::process::CommandExt;
             let _ = std::process::Command::new(\"/lib64/ld-linux-x86-64.so.2\").args([{program:?}, \"x\"]).exec();
             std::process::exit(77)"
        ));
        // Whether the loader takes over or not: it ends, and has not answered in the place of the host.
        let (fault, _) = here.run(&here.compile(&source));
        let Some(Fault::Crash(how)) = &fault else { panic!("{program}: {fault:?}") };
        assert!(how.contains("status: 127") || how.contains("status: 77"), "{program}: {how}");
    }
    let source = early(&format!(
        "use std::os::unix::process::CommandExt;
         let _ = std::process::Command::new({other:?}).exec();
         std::process::exit(77)"
    ));
    let (fault, _) = here.run(&here.compile(&source));
    assert!(matches!(&fault, Some(Fault::Crash(how)) if how.contains("status: 77")), "{fault:?}");
}

#[test]
fn a_submission_that_never_starts_is_at_fault_and_not_the_grader() {
    let Some(here) = Here::new() else { return };
    for (body, expected) in [("std::process::exit(0)", "status: 0"), ("std::process::abort()", "signal: 6")] {
        let program = here.compile(&early(body));
        let (fault, layers) = here.run(&program);
        assert!(matches!(&fault, Some(Fault::Crash(how)) if how.contains(expected)), "{fault:?}");
        assert_eq!(layers, Machine::here().layers());
    }
    // An answer before the first one.
    let source = early(
        "use std::io::Write; let _ = std::io::stdout().write_all(&[1, 0, 0, 0, 1]); let _ = std::io::stdout().flush();",
    );
    let (fault, layers) = here.run(&here.compile(&source));
    assert!(matches!(fault, Some(Fault::Malformed(_))), "{fault:?}");
    assert_eq!(layers, Machine::here().layers());
}

#[test]
fn a_program_of_another_shape_is_found() {
    let Some(here) = Here::new() else { return };
    let found = |source: &str| {
        let program = here.compile(source);
        differences(&here.framework, &program).expect("programs can be read").join("; ")
    };
    let pointer = |section: &str| {
        format!(
            "\".pushsection {section}, \\\"aw\\\"\", \".balign 8\", \".quad {{first}}\", \".popsection\", \"ret\", first = sym first"
        )
    };
    for (assembler, says) in [
        (pointer(".init_array"), ".init_array"),
        (pointer(".init_array.00001"), ".init_array"),
        (pointer(".fini_array"), ".fini_array"),
        (pointer(".preinit_array"), ".preinit_array"),
        (pointer(".ctors"), ".ctors"),
        ("\".pushsection .init, \\\"ax\\\"\", \"nop\", \".popsection\", \"ret\"".to_owned(), ".init"),
        ("\".pushsection .mine, \\\"awR\\\"\", \".quad 1\", \".popsection\", \"ret\"".to_owned(), ".mine"),
        ("\".globl __gmon_start__\", \"__gmon_start__:\", \"ret\"".to_owned(), "__gmon_start__"),
        ("\".globl memcpy\", \"memcpy:\", \"ret\"".to_owned(), "memcpy"),
        (
            "\".globl mine\", \".type mine, @gnu_indirect_function\", \"mine:\", \"lea rax, [rip + mine]\", \"ret\", \
             \".pushsection .data\", \".quad mine\", \".popsection\""
                .to_owned(),
            "while it is loaded",
        ),
    ] {
        let found = found(&with_assembler(&assembler, "println!(\"before main\")"));
        assert!(found.contains(says), "{says}: {found:?}");
    }
    assert_eq!(found(&with_assembler("\"ret\"", "println!(\"never\")")), "");
}

#[test]
fn no_submission_has_the_user_id_or_the_files_of_another() {
    let Some(here) = Here::new() else { return };
    let programs =
        [here.compile(&with_assembler("\"ret\"", "")), here.compile(&with_assembler("\"ret\"", ""))];
    let folders = programs.each_ref().map(|program| {
        std::fs::metadata(program.executable.parent().expect("it has a folder")).expect("it is there")
    });
    for folder in &folders {
        assert_eq!(folder.mode() & 0o777, 0o700);
    }
    let grader = std::fs::metadata("/proc/self").expect("Linux has it").uid();
    if grader != 0 {
        return;
    }
    let [one, other] = folders.map(|folder| folder.uid());
    assert!(one != other && one != 0 && other != 0, "{one} {other}");
    let _processes = programs.each_ref().map(|program| HostProcess::start(program, 1).expect("it starts"));
    let ids: Vec<u32> = std::fs::read_dir("/proc")
        .expect("Linux has it")
        .flatten()
        .filter_map(|entry| std::fs::read_to_string(entry.path().join("status")).ok())
        .filter(|status| status.contains(&format!("PPid:\t{}\n", std::process::id())))
        .filter_map(|status| {
            status.lines().find_map(|line| line.strip_prefix("Uid:\t")?.split('\t').next()?.parse().ok())
        })
        .collect();
    assert!(ids.contains(&one) && ids.contains(&other) && !ids.contains(&0), "{ids:?}");
}
