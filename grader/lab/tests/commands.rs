//! The command line of the laboratory.

use std::io::Read;
use std::path::Path;
use std::process::{Command, Output};

fn lab(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_lab"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .expect("the program starts")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
fn the_autograder_is_a_zip_that_gradescope_takes() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let made = lab(folder.path(), &["gradescope"]);
    assert_eq!(made.status.code(), Some(0), "{}", text(&made.stderr));
    let file = std::fs::File::open(folder.path().join("autograder.zip")).expect("it is there");
    let mut archive = zip::ZipArchive::new(file).expect("it is a zip");
    for name in ["setup.sh", "run_autograder"] {
        let entry = archive.by_name(name).expect("it is at the top");
        assert_eq!(entry.unix_mode().map(|mode| mode & 0o777), Some(0o755), "{name}");
    }
    let needed =
        ["Cargo.lock", ".cargo/config.toml", "solution/src/algorithms/render_pt.rs", "grader/src/main.rs"];
    for name in needed {
        assert!(archive.by_name(name).is_ok(), "{name}");
    }
    // Cargo refuses a workspace that names a member without a manifest.
    let mut manifest = String::new();
    archive.by_name("Cargo.toml").expect("it is there").read_to_string(&mut manifest).expect("it is text");
    let manifest: toml_edit::DocumentMut = manifest.parse().expect("it is TOML");
    for member in manifest["workspace"]["members"].as_array().expect("there are members") {
        let name = format!("{}/Cargo.toml", member.as_str().expect("a folder"));
        assert!(archive.by_name(&name).is_ok(), "{name}");
    }
}

#[test]
fn a_scene_that_no_check_uses_has_no_reference() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let refused = lab(folder.path(), &["reference", "nonsense"]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(text(&refused.stderr).contains("no check uses a scene `nonsense`"), "{}", text(&refused.stderr));
}
