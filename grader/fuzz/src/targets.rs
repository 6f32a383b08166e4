//! What is fuzzed: each target reads bytes as somebody else sent them. It may refuse them, but must not panic, hang, or use
//! memory that the bytes do not account for.

use std::path::{Path, PathBuf};

use arty::image::exr::ExrFile;
use classroom::class::{layout, roster};
use classroom::policy::{Course, Manifest, zone};
use host::protocol::{MAX_MESSAGE, Request, Response, read_message};
use tempfile::TempDir;
use verdict::rubric::Rubric;

/// A target: its name, which is that of its folder in `corpus`, and what it does.
pub type Target = (&'static str, fn(&[u8]));

/// All targets.
pub const TARGETS: [Target; 8] = [
    ("archives", archives),
    ("repository", repository),
    ("scene", scene),
    ("mesh", mesh),
    ("exr", exr),
    ("protocol", protocol),
    ("rubric", rubric),
    ("tables", tables),
];

/// The student's file of exercise 5, with this starting file.
fn wanted(starter: &str) -> intake::Wanted {
    let [file_name, type_name, starter] = ["render_pt.rs", "PathTracer", starter].map(str::to_owned);
    intake::Wanted { file_name, type_name, starter }
}

/// A file that a student sent; the first byte selects its name.
pub fn archives(data: &[u8]) {
    const NAMES: [&str; 6] = ["a.zip", "a.tar.gz", "a.tar", "render_pt.rs", "why.txt", "unknown"];
    let Some((first, bytes)) = data.split_first() else { return };
    let name = NAMES[usize::from(*first) % NAMES.len()];
    let intake = intake::take_bytes(name, bytes, &wanted("pub struct PathTracer;\n"));
    let findings = intake.notes.iter().map(ToString::to_string);
    for text in findings.chain(intake.outcome.err().map(|refusal| refusal.to_string())) {
        assert!(!text.chars().any(char::is_control), "{text:?}");
    }
}

/// A pack of a git repository: the id of the last commit, the length of the index (four bytes), the index, the pack.
pub fn repository(data: &[u8]) {
    let Some((id, rest)) = data.split_at_checked(20) else { return };
    let Some((length, rest)) = rest.split_first_chunk::<4>() else { return };
    let Some((index, pack)) = rest.split_at_checked(u32::from_le_bytes(*length) as usize) else { return };
    let id: String = id.iter().map(|byte| format!("{byte:02x}")).collect();
    let folder = folder();
    write(&folder, ".git/HEAD", id.as_bytes());
    write(&folder, ".git/refs/heads/x", b"");
    write(&folder, ".git/objects/pack/a.idx", index);
    write(&folder, ".git/objects/pack/a.pack", pack);
    let _ = intake::take(&[folder.path().to_owned()], &wanted(""), None);
}

/// A scene file.
pub fn scene(data: &[u8]) {
    let folder = folder();
    write(&folder, "a.obj", b"mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n");
    write(&folder, "a.mtl", b"newmtl a\nKd 1 1 1\n");
    let _ = arty::scene::file::load(&write(&folder, "a.yml", data));
}

/// A mesh and its materials, with a zero byte between them.
pub fn mesh(data: &[u8]) {
    let folder = folder();
    let mut parts = data.splitn(2, |&byte| byte == 0);
    write(&folder, "a.obj", parts.next().unwrap_or_default());
    write(&folder, "a.mtl", parts.next().unwrap_or_default());
    let scene = b"meshes: [a.obj]\ncamera: !perspective_camera { eye: [0, 0, 5], center: [0, 0, 0], up: [0, 1, 0], fov: 40 }\n";
    let _ = arty::scene::file::load(&write(&folder, "a.yml", scene));
}

/// An image in the format OpenEXR.
pub fn exr(data: &[u8]) {
    let folder = folder();
    let _ = ExrFile::read(&write(&folder, "a.exr", data));
}

/// Messages between grader and host.
pub fn protocol(data: &[u8]) {
    let _ = read_message::<Response>(&mut &*data, MAX_MESSAGE);
    if let Ok(Some(bytes)) = host::protocol::read_bytes(&mut &*data, MAX_MESSAGE) {
        let _ = host::protocol::decode::<Request<'_>>(&bytes);
    }
}

/// A rubric, or the settings of a course.
pub fn rubric(data: &[u8]) {
    let folder = folder();
    let file = write(&folder, "a.yml", data);
    let _ = Rubric::load(&file);
    let _ = Course::load(&file);
}

/// Tables: a roster, a manifest; and folders named by the first lines of the file.
pub fn tables(data: &[u8]) {
    let folder = folder();
    let file = write(&folder, "a.csv", data);
    let _ = roster::load(&file, true);
    if let Ok(zone) = zone("Europe/Berlin") {
        let _ = Manifest::load(&file, &zone);
    }
    let text = String::from_utf8_lossy(data);
    for name in text.lines().take(4).filter(|name| !name.contains(['/', '\0']) && name.len() < 200) {
        // Names such as `..` are there already.
        let _ = std::fs::create_dir(folder.path().join(name));
    }
    let _ = layout::submissions(folder.path());
}

/// A temporary folder, in memory where the system has one for that.
fn folder() -> TempDir {
    let memory = Path::new("/dev/shm");
    let parent = if memory.is_dir() { memory.to_owned() } else { std::env::temp_dir() };
    tempfile::tempdir_in(parent).expect("a temporary folder can be made")
}

fn write(folder: &TempDir, name: &str, bytes: &[u8]) -> PathBuf {
    let path = folder.path().join(name);
    if let Some(parent) = path.parent() {
        std::fs::create_dir_all(parent).expect("it can be made");
    }
    std::fs::write(&path, bytes).expect("it can be written");
    path
}
