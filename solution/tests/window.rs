//! The window with the solution: real keys and a real mouse in a virtual display, screenshots compared with files that the
//! command line renders.
//!
//! Needs Xvfb and xdotool; without them, the tests with a display are skipped.

#![cfg(all(feature = "view", target_os = "linux"))]

mod desktop;

use std::fs::File;
use std::path::PathBuf;
use std::process::Command;
use std::time::Duration;

use arty::camera::CameraDescription;
use arty::image::exr::ExrFile;
use arty_view::look::{Look, ToneMap};

use desktop::{Desktop, Program, Shot};

/// A small picture of which all passes together take a moment.
const SIZE: (usize, usize) = (256, 206);
const SAMPLES: u64 = 8;

fn scene() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../scenes/cornell_box.yml")
}

/// What the command line renders, as colours on the screen.
fn rendered(program: &Program, technique: &str, exposure: f32) -> Shot {
    let file = program.folder().join(format!("{technique}.exr"));
    if !file.is_file() {
        let mut command = Command::new(env!("CARGO_BIN_EXE_solution"));
        command
            .arg(scene())
            .args(["--quiet", "--width=256", "--samples=8"])
            .arg(format!("--technique={technique}"));
        let status = command.arg("-o").arg(&file).status().expect("the program starts");
        assert!(status.success());
    }
    shown(&file, exposure)
}

fn shown(file: &std::path::Path, exposure: f32) -> Shot {
    let file = ExrFile::read(file).expect("an OpenEXR file");
    assert_eq!((file.width, file.height), SIZE);
    let look = Look { exposure, tone_map: ToneMap::Clamp };
    let image = file.layer("").expect("a picture");
    Shot { width: SIZE.0, pixels: image.pixels().iter().map(|&pixel| look.color(pixel)).collect() }
}

/// The window after it has shown all samples of a technique.
fn finished(program: &Program, technique: &str) -> Shot {
    program.wait_for_title(&format!("{technique} {SAMPLES} spp"));
    program.settled_shot(SIZE)
}

fn open(desktop: &Desktop) -> Program<'_> {
    let mut command = Command::new(env!("CARGO_BIN_EXE_solution-view"));
    command.arg(scene()).args(["--width=256", "--place=0,0,256,206", "--samples=8", "--technique=nee"]);
    desktop.open(command)
}

#[test]
fn keys_and_mouse_change_the_picture_and_files_are_those_of_the_command_line() {
    let Some(desktop) = Desktop::start() else { return };
    let mut program = open(&desktop);

    // The picture, by another technique, and brighter.
    let nee = finished(&program, "nee");
    nee.assert_same(&rendered(&program, "nee", 0.0), "the first picture");
    program.key("r");
    finished(&program, "mis").assert_same(&rendered(&program, "mis", 0.0), "after R");
    program.key("2");
    finished(&program, "nee").assert_same(&nee, "after 2");
    program.key("plus");
    program.key("Escape");
    program.wait_for_shot(SIZE, &rendered(&program, "nee", 0.5), "after +");
    program.key("0");

    // The camera: keys and mouse lead away from the scene's, Home leads back.
    for motion in ["Left", "w"] {
        program.key(motion);
        assert!(finished(&program, "nee").differs_from(&nee) > 1000, "{motion} moves the camera");
    }
    program.drag((100, 100), (140, 120));
    assert!(finished(&program, "nee").differs_from(&nee) > 1000, "the mouse moves the camera");
    program.key("p");
    let camera = program.wait_for_output("camera: ");
    program.key("Home");
    program.key("Escape");
    program.wait_for_shot(SIZE, &nee, "after Home");
    program.key("p");
    let home = program.wait_for_output("camera: ");
    assert_ne!(camera, home);
    let described = arty::scene::file::load(&scene()).expect("a scene").description.camera;
    let CameraDescription { eye, .. } = described;
    assert!(home.contains(&format!("eye: [{}, {}, {}]", eye.x, eye.y, eye.z)), "{home}");

    // Paths: drawn over the picture, gone after Escape.
    program.key("Escape");
    program.click((75, 150));
    // Without the numbers, which have the same colours.
    program.key("i");
    program.wait_for("shadow rays", |shot| shot.count(0x40_e8_60) + shot.count(0xff_50_40) > 20, SIZE);
    program.key("period");
    program.key("b");
    program.key("Escape");
    program.wait_for_shot(SIZE, &nee, "after Escape");

    // Files.
    program.key("S");
    program.wait_for_output("saved cornell_box-nee.png, cornell_box-nee.exr");
    shown(&program.folder().join("cornell_box-nee.exr"), 0.0).assert_same(&nee, "the saved picture");

    // The wipe: one technique at each side of the divider.
    program.key("v");
    program.wait_for_title("nee 8 spp");
    program.wait_for_title("mis 8 spp");
    let mis = rendered(&program, "mis", 0.0);
    let halves = |shot: &Shot| {
        let rows = 0..SIZE.1 - 30;
        let left = rows.clone().all(|y| (0..120).all(|x| shot.at(x, y) == nee.at(x, y)));
        left && rows.clone().all(|y| (136..SIZE.0).all(|x| shot.at(x, y) == mis.at(x, y)))
    };
    program.wait_for("a wipe", halves, SIZE);
}

/// A saved file: the same content with another time. What stands in for cargo fails first, and then succeeds.
#[test]
fn a_saved_file_is_compiled_and_the_window_goes_on_with_its_camera() {
    let Some(desktop) = Desktop::start() else { return };
    let folder = tempfile::tempdir().expect("a folder");
    let (cargo, fixed, calls) =
        (folder.path().join("cargo"), folder.path().join("fixed"), folder.path().join("calls"));
    let script = format!(
        "#!/bin/sh\necho \"$@\" >> {}\n[ -e {} ] || {{ echo 'error: expected an expression' >&2; exit 101; }}\n",
        calls.display(),
        fixed.display()
    );
    std::fs::write(&cargo, script).expect("writing works");
    std::fs::set_permissions(&cargo, std::os::unix::fs::PermissionsExt::from_mode(0o755))
        .expect("it is ours");
    let source =
        File::open(concat!(env!("CARGO_MANIFEST_DIR"), "/src/algorithms/render_pt.rs")).expect("a file");
    let saved = source.metadata().and_then(|metadata| metadata.modified()).expect("it has a time");
    let save = |seconds| source.set_modified(saved + Duration::from_secs(seconds)).expect("it is ours");

    let mut command = Command::new(env!("CARGO_BIN_EXE_solution-view"));
    command
        .arg(scene())
        .args(["--width=256", "--place=0,0,256,206", "--samples=8", "--technique=nee", "--watch"])
        .env("CARGO", &cargo);
    let mut program = desktop.open(command);
    program.key("Left");
    program.key("r");
    let moved = finished(&program, "mis");
    save(1);
    // The message is below, and the picture stays.
    let has_message = |shot: &Shot| {
        let upper = 0..SIZE.1 - 40;
        shot.count(0xff_90_70) > 20
            && upper.clone().all(|y| (0..SIZE.0).all(|x| shot.at(x, y) == moved.at(x, y)))
    };
    program.wait_for("the compiler's message", has_message, SIZE);
    std::fs::write(&fixed, "").expect("writing works");
    save(2);
    program.wait_for_restart("--camera=");
    finished(&program, "mis").assert_same(&moved, "after the reload");
    save(0);
    let calls = std::fs::read_to_string(&calls).expect("it was called");
    assert!(calls.starts_with("build --bin=solution-view --features=solution/view --profile="), "{calls}");
}

#[test]
fn a_moved_camera_is_shown_at_once_and_input_is_never_blocked() {
    let Some(desktop) = Desktop::start() else { return };
    let mut command = Command::new(env!("CARGO_BIN_EXE_solution-view"));
    // Far more work than can be done within the test.
    command.arg(scene()).args(["--width=800", "--max-bounces=50"]);
    let program = desktop.open(command);
    program.wait_for_title(" 1 spp");
    let size = (800, 600);
    let mut times = Vec::new();
    for _ in 0..10 {
        let before = program.shot(size);
        let pressed = std::time::Instant::now();
        program.key("Left");
        program.wait_for("another picture", |shot| shot.differs_from(&before) > 1000, size);
        times.push(pressed.elapsed());
    }
    times.sort_unstable();
    // The time includes xdotool and the test's own look at the screen.
    println!("from a key to another picture: median {:?}, longest {:?}", times[5], times[9]);
    assert!(times[5] < Duration::from_secs(1), "{times:?}");
}

#[test]
fn without_a_display_one_error_says_what_to_do() {
    let mut command = Command::new(env!("CARGO_BIN_EXE_solution-view"));
    command.arg(scene()).env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET");
    let output = command.output().expect("the program starts");
    let text = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{text}");
    assert_eq!(text.lines().count(), 1, "{text}");
    assert!(text.starts_with("error: ") && text.contains("--output") && text.contains("--tev"), "{text}");
}
