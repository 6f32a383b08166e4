//! The program, run as a process.

#![cfg(feature = "cli")]

use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

use arty::image::exr::{ExrFile, Precision};

/// An emissive triangle in front of the camera and a point light, which BSDF sampling never finds.
const SCENE: &str = "\
meshes: []
camera: !perspective_camera { eye: [0, 0, 4], center: [0, 0, 0], up: [0, 1, 0], fov: 40 }
lights:
  - !triangle_light { v0: [-1, -1, 0], v1: [1, -1, 0], v2: [0, 1, 0], color: [2, 1, 0.5] }
  - !point_light { position: [0, 2, 1], color: [10, 10, 10] }
defaults: { width: 40, height: 30, max_bounces: 3 }
";
/// Its last statement is a line, which is ignored with a warning.
const FLOOR: &str = "v -2 -1 -2\nv 2 -1 -2\nv 2 -1 2\nv -2 -1 2\nf 4 3 2 1\nl 1 2\n";

/// A working folder with a scene.
struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        let folder = Self(tempfile::tempdir().expect("a folder"));
        folder.write("scene.yml", SCENE);
        folder
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).expect("writing works");
    }

    /// The program with arguments separated by spaces.
    fn command(&self, arguments: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_arty"));
        command.current_dir(self.0.path()).args(arguments.split_whitespace()).stdin(Stdio::null());
        command
    }

    fn run(&self, arguments: &str) -> Run {
        Run::from(self.command(arguments).output().expect("the program starts"))
    }

    /// Runs the program, which has to succeed.
    fn render(&self, arguments: &str) -> Run {
        let run = self.run(arguments);
        assert_eq!(run.status, Some(0), "{arguments}: {}", run.stderr);
        run
    }

    fn exr(&self, name: &str) -> ExrFile {
        ExrFile::read(&self.path(name)).expect("an OpenEXR file")
    }

    /// The names of all files except the scene, hidden ones included.
    fn files(&self) -> Vec<String> {
        let entries = fs::read_dir(self.0.path()).expect("the folder can be listed");
        let names = entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned());
        let mut names: Vec<String> = names.filter(|name| name != "scene.yml").collect();
        names.sort();
        names
    }
}

/// Exit status and output of the program.
struct Run {
    status: Option<i32>,
    stdout: String,
    stderr: String,
}

impl From<Output> for Run {
    fn from(output: Output) -> Self {
        Self {
            status: output.status.code(),
            stdout: String::from_utf8(output.stdout).expect("text"),
            stderr: String::from_utf8(output.stderr).expect("text"),
        }
    }
}

#[test]
fn an_image_is_saved_in_the_current_folder() {
    let folder = Folder::new();
    let run = folder.render("--algo=pt scene.yml --samples=2");
    assert_eq!(folder.files(), ["scene-mis.png"]);
    let picture = image::open(folder.path("scene-mis.png")).expect("a PNG file").into_rgb8();
    assert_eq!(picture.dimensions(), (40, 30), "as the scene suggests");
    // Radiance (2, 1, 0.5): cut off at white, white, and level 188.
    assert_eq!(picture.get_pixel(20, 15).0, [255, 255, 188]);
    assert_eq!(picture.get_pixel(0, 0).0, [0, 0, 0]);
    assert_eq!(run.stdout, "", "results go to files");
    assert!(run.stderr.contains("2 samples per pixel in ") && run.stderr.contains("saved scene-mis.png"));
    assert!(!run.stderr.contains('\x1b'), "no colours for a file: {}", run.stderr);
}

#[test]
fn exposure_brightens_the_png() {
    let folder = Folder::new();
    folder.render("scene.yml -s 1 --exposure=-1 -o dark.png --quiet");
    let picture = image::open(folder.path("dark.png")).expect("a PNG file").into_rgb8();
    assert_eq!(picture.get_pixel(20, 15).0, [255, 188, 137], "half of (2, 1, 0.5)");
}

#[test]
#[cfg(unix)]
fn the_window_is_another_program_with_the_same_options() {
    let folder = Folder::new();
    // What stands in for Cargo.
    let cargo = folder.path("cargo");
    std::fs::write(&cargo, "#!/bin/sh\necho \"$@\"\nexit 7\n").expect("it can be written");
    std::fs::set_permissions(&cargo, std::os::unix::fs::PermissionsExt::from_mode(0o755))
        .expect("it is ours");
    let mut command = folder.command("scene.yml --view --technique=nee --watch");
    let output = command.env("CARGO", &cargo).output().expect("the program starts");
    assert_eq!(output.status.code(), Some(7), "the window's own");
    let line = String::from_utf8_lossy(&output.stdout);
    assert!(
        line.starts_with("run --release --bin arty-view --features arty-view/window --manifest-path"),
        "{line}"
    );
    assert!(line.ends_with(" -- scene.yml --technique=nee --watch\n"), "{line}");
}

#[test]
fn an_openexr_file_contains_its_provenance() {
    let folder = Folder::new();
    folder.render("scene.yml -sx 20 -sy=10 -s 16 --seed=7 --technique=nee --max-bounces=2 -o a.exr -o b.png");
    assert_eq!(folder.files(), ["a.exr", "b.png"]);
    let file = folder.exr("a.exr");
    assert_eq!((file.width, file.height), (20, 10));
    let entries = [
        ("scene", "scene.yml"),
        ("seed", "7"),
        ("algorithm", "pt"),
        ("technique", "nee"),
        ("max_bounces", "2"),
        ("samples_per_pixel", "16"),
        ("non_finite", "0"),
        ("negative", "0"),
        ("interrupted", "false"),
    ];
    for (name, value) in entries {
        assert_eq!(file.metadata.get(&format!("arty:{name}")).map(String::as_str), Some(value), "{name}");
    }
    assert_eq!(file.metadata["arty:scene_hash"].len(), 64);
    assert!(file.metadata["arty:render_seconds"].parse::<f64>().is_ok_and(|seconds| seconds > 0.0));
    let folder_name = folder.0.path().to_string_lossy();
    assert!(!file.metadata.values().any(|value| value.contains(&*folder_name)), "nothing about this machine");

    // A pixel at the edge of the triangle: k of 16 samples see radiance 2, so the variance of the mean is
    // 4 · k/16 · (1 − k/16) / 15.
    let (mean, variance) = (file.layer("").expect("a mean"), file.layer("variance").expect("a variance"));
    let edges = mean.pixels().iter().zip(variance.pixels()).filter(|(mean, _)| mean.r > 0.0 && mean.r < 2.0);
    assert!(edges.clone().count() > 5);
    for (mean, variance) in edges {
        let expected = mean.r * (2.0 - mean.r) / 15.0;
        assert!((variance.r - expected).abs() < 1e-5, "{mean:?}: {variance:?}");
    }
}

#[test]
fn one_sample_has_no_variance() {
    let folder = Folder::new();
    folder.render("scene.yml -s 1 -o a.exr");
    assert_eq!(folder.exr("a.exr").layer("variance"), None);
}

#[test]
fn neither_threads_nor_passes_change_the_image() {
    let folder = Folder::new();
    folder.render("scene.yml -s 8 --threads=1 -o one.exr");
    folder.render("scene.yml -s 8 --threads=2 -o two.exr");
    // The time limit is not reached, but it divides the work differently.
    folder.render("scene.yml -s 8 --time=600 --threads=3 -o three.exr");
    folder.render("scene.yml -s 8 --seed=1 -o other.exr");
    let channels = |name| folder.exr(name).channels;
    assert_eq!(channels("one.exr"), channels("two.exr"));
    assert_eq!(channels("one.exr"), channels("three.exr"));
    assert_ne!(channels("one.exr"), channels("other.exr"));
}

#[test]
fn rendering_can_be_limited_by_time() {
    let folder = Folder::new();
    folder.render("scene.yml -t 0.3 -o a.exr");
    let metadata = folder.exr("a.exr").metadata;
    assert!(metadata["arty:samples_per_pixel"].parse::<u64>().is_ok_and(|samples| samples > 64));
    assert!(metadata["arty:render_seconds"].parse::<f64>().is_ok_and(|seconds| seconds >= 0.3));
}

#[test]
fn debug_images_show_surfaces() {
    let folder = Folder::new();
    folder.write("floor.obj", FLOOR);
    folder.write("scene.yml", &SCENE.replace("[]", "[floor.obj]"));
    folder.render("scene.yml -a debug -s 4 -o normals.exr");
    let file = folder.exr("normals.exr");
    assert_eq!(file.metadata["arty:show"], "normals");
    assert!(!file.metadata.contains_key("arty:technique"));
    let normals = file.layer("").expect("a mean");
    assert_eq!(normals[(20, 15)].to_array(), [0.5, 0.5, 1.0], "the triangle faces the camera");
    assert_eq!(normals[(5, 28)].to_array(), [0.5, 1.0, 0.5], "the floor faces up");
    folder.render("scene.yml -a debug --show=albedo -s 4 -o albedo.exr");
    let albedo = folder.exr("albedo.exr").layer("").expect("a mean");
    assert!((albedo[(5, 28)].r - 0.5).abs() < 1e-5, "grey without a material");
}

#[test]
fn scene_warnings_are_printed_with_file_and_line() {
    let folder = Folder::new();
    folder.write("floor.obj", FLOOR);
    folder.write("scene.yml", &SCENE.replace("[]", "[floor.obj]"));
    for quiet in ["", "--quiet"] {
        let run = folder.render(&format!("scene.yml -s 1 {quiet}"));
        let is_warning = |line: &str| line.starts_with("warning: floor.obj:6: ");
        assert!(run.stderr.lines().any(is_warning), "{}", run.stderr);
        let all_are_warnings = run.stderr.lines().all(|line| line.starts_with("warning: "));
        assert_eq!(all_are_warnings, !quiet.is_empty(), "{}", run.stderr);
    }
}

#[test]
fn lights_that_bsdf_sampling_cannot_find_are_noted() {
    let folder = Folder::new();
    let note = "note: BSDF sampling never finds a point light";
    let run = folder.render("scene.yml -s 1 --technique=bsdf");
    assert!(
        run.stderr.contains(note) && run.stderr.contains("1 point light will be missing"),
        "{}",
        run.stderr
    );
    assert!(!folder.render("scene.yml -s 1 --technique=mis").stderr.contains(note));
    folder.write("scene.yml", &SCENE.replace("lights:\n", "").replace("  - ", "# "));
    let run = folder.render("scene.yml -s 1");
    assert!(run.stderr.contains("note: the scene has no lights"), "{}", run.stderr);
}

#[test]
fn features_are_printed_and_nothing_is_rendered() {
    let folder = Folder::new();
    folder.write("floor.obj", FLOOR);
    folder.write("scene.yml", &SCENE.replace("[]", "[floor.obj]"));
    let run = folder.render("scene.yml --features -o missing/x.png");
    for line in
        ["image size         40 x 30", "max bounces        3", "triangles          3", "area lights        1"]
    {
        assert!(run.stdout.lines().any(|printed| printed == line), "{line}: {}", run.stdout);
    }
    assert!(run.stdout.contains("warning: floor.obj:6: "), "{}", run.stdout);
    let hash = run.stdout.lines().find_map(|line| line.strip_prefix("content hash       "));
    folder.render("scene.yml -s 1 -o a.exr");
    assert_eq!(hash, Some(&*folder.exr("a.exr").metadata["arty:scene_hash"]));
    assert_eq!((run.stderr.as_str(), folder.files()), ("", vec!["a.exr".to_owned(), "floor.obj".to_owned()]));
}

#[test]
fn errors_are_reported_before_rendering() {
    let folder = Folder::new();
    folder.write("broken.yml", &SCENE.replace("fov: 40", "fov: 400"));
    fs::create_dir(folder.path("folder.png")).expect("a folder");
    // Rendering that many samples first would take forever.
    let cases = [
        ("scene.yml -s 999999999 -o x.jpg", "error: invalid value 'x.jpg'"),
        (
            "scene.yml -s 999999999 -o missing/x.png",
            "error: missing/x.png: cannot be written: no such folder",
        ),
        ("scene.yml -s 999999999 -o folder.png", "error: folder.png: cannot be written: it is a folder"),
        ("scene.yml -s 999999999 -o ok.png -o missing/x.exr", "error: missing/x.exr: cannot be written"),
        ("scene.yml -s 999999999 --width=65536 --height=65536", "error: 65536 x 65536 pixels are too many"),
        ("broken.yml -s 999999999", "error: broken.yml:2: "),
        ("nowhere.yml", "error: nowhere.yml: no such file"),
        ("skene.yml", "error: skene.yml: no such file"),
        ("scene.yml --technique=luck", "error: invalid value 'luck'"),
        ("", "error: the following required arguments"),
    ];
    for (arguments, message) in cases {
        let run = folder.run(arguments);
        assert_eq!(run.status, Some(2), "{arguments}: {}", run.stderr);
        assert!(run.stderr.starts_with(message), "{arguments}: {}", run.stderr);
        assert_eq!(run.stdout, "");
    }
    assert_eq!(folder.files(), ["broken.yml", "folder.png"], "no file was created");
}

#[test]
fn an_unreachable_viewer_gives_one_warning() {
    let folder = Folder::new();
    // Port 1 is privileged, and nothing listens there.
    let run = folder.render("scene.yml -t 1.5 --tev=127.0.0.1:1 --quiet");
    assert_eq!(run.stderr.matches("warning: cannot reach the tev viewer at 127.0.0.1:1").count(), 1);
    assert_eq!(run.stderr.lines().count(), 1);
    assert_eq!(folder.files(), ["scene-mis.png"]);
}

#[test]
fn help_and_version_go_to_stdout() {
    let folder = Folder::new();
    let help = folder.render("--help");
    assert!(help.stdout.contains("arty --algo=pt scenes/cornell_box_water.yml --width=512 --height=412"));
    assert_eq!(folder.render("--version").stdout, concat!("arty ", env!("CARGO_PKG_VERSION"), "\n"));
}

#[cfg(unix)]
#[test]
fn an_interruption_saves_the_samples_so_far() {
    use std::io::{BufRead, BufReader, Read};

    let folder = Folder::new();
    let mut command = folder.command("scene.yml --samples=999999999 --time=600 -o a.exr");
    let mut program = command.stderr(Stdio::piped()).spawn().expect("the program starts");
    let mut stderr = BufReader::new(program.stderr.take().expect("it is piped"));
    let mut line = String::new();
    while !line.starts_with("rendering ") {
        line.clear();
        assert_ne!(stderr.read_line(&mut line).expect("text"), 0, "it ended too early");
    }
    std::thread::sleep(std::time::Duration::from_millis(500));
    let id = program.id().to_string();
    assert!(Command::new("kill").args(["-INT", &id]).status().expect("there is such a program").success());
    let mut rest = String::new();
    stderr.read_to_string(&mut rest).expect("text");
    assert_eq!(program.wait().expect("it ends").code(), Some(130), "{rest}");
    assert!(rest.contains("interrupted: ") && rest.contains("saved a.exr"), "{rest}");
    let metadata = folder.exr("a.exr").metadata;
    assert_eq!(metadata["arty:interrupted"], "true");
    assert!(metadata["arty:samples_per_pixel"].parse::<u64>().is_ok_and(|samples| samples > 0));
}

#[test]
fn the_error_against_a_reference_is_printed_and_saved() {
    let folder = Folder::new();
    folder.render(
        "scene.yml --width=20 --samples=256 --seed=9 --technique=bsdf --max-bounces=1 -o reference.exr",
    );
    let run = folder.render("scene.yml --samples=64 --technique=bsdf --reference=reference.exr");
    assert!(run.stdout.contains("64 samples") && run.stdout.contains("relMSE"), "{}", run.stdout);
    let picture = image::open(folder.path("scene-bsdf.png")).expect("a PNG file");
    assert_eq!((picture.width(), picture.height()), (20, 15), "the size is that of the reference");
    assert!(run.stderr.contains("1 bounce)"), "and so are the bounces: {}", run.stderr);
    let table = fs::read_to_string(folder.path("scene.errors.csv")).expect("the table is there");
    let rows: Vec<Vec<f64>> = table
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(|cell| cell.parse().expect("a number")).collect())
        .collect();
    assert!(table.starts_with("samples_per_pixel,seconds,relative_mse,") && rows.len() > 2, "{table}");
    assert_eq!(rows.last().map(|row| row[0]), Some(64.0));
    assert!(rows.windows(2).all(|pair| pair[0][0] < pair[1][0] && pair[0][1] <= pair[1][1]), "{table}");
    // The error of the first sample is dozens of times that of all 64, with this seed.
    assert!(rows[0][2] > 4.0 * rows[rows.len() - 1][2], "{table}");
}

#[test]
fn an_unusable_reference_is_refused_before_rendering() {
    let folder = Folder::new();
    folder.render("scene.yml --width=20 --samples=1 -o reference.exr");
    let picture = folder.exr("reference.exr").layer("").expect("the picture");
    let layers = ExrFile { width: 20, height: 15, ..ExrFile::default() }.with_layer("beauty", &picture);
    layers.write(&folder.path("layers.exr"), Precision::Full).expect("it can be written");
    for (arguments, expected) in [
        ("scene.yml --reference=reference.exr --width=30", "20 x 15 pixels"),
        ("scene.yml --reference=missing.exr", "missing.exr"),
        ("scene.yml --reference=layers.exr", "but beauty.B, beauty.G, beauty.R; save the layer"),
        ("scene.yml --reference=scene.yml", "scene.yml"),
    ] {
        let run = folder.run(arguments);
        assert_eq!(run.status, Some(2), "{arguments}: {}", run.stderr);
        assert!(run.stderr.contains(expected), "{arguments}: {}", run.stderr);
    }
    assert!(!folder.path("scene.errors.csv").exists() && !folder.path("scene-bsdf.png").exists());
}
