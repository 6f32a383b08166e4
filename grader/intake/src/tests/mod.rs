//! Submissions as they come, made in memory or in a temporary folder.

mod sources;

use std::io::{Cursor, Write};
use std::path::Path;

use flate2::Compression;
use flate2::write::GzEncoder;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

use super::*;

const SOURCE: &str = "pub struct PathTracer;\n";
const STARTER: &str = "// TASK\npub struct PathTracer;\n";

/// The usual file, with this starting file.
fn wanted(starter: &str) -> Wanted {
    let [file_name, type_name, starter] = ["render_pt.rs", "PathTracer", starter].map(str::to_owned);
    Wanted { file_name, type_name, starter }
}

fn zip(entries: &[(&str, &[u8])]) -> Vec<u8> {
    let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes) in entries {
        let options = SimpleFileOptions::default().compression_method(CompressionMethod::Deflated);
        writer.start_file(*name, options).expect("it can be started");
        writer.write_all(bytes).expect("it can be written");
    }
    writer.finish().expect("it can be finished").into_inner()
}

fn tar(entries: &[(&str, &[u8])]) -> Vec<u8> {
    let mut builder = tar::Builder::new(Vec::new());
    for (name, bytes) in entries {
        let mut header = tar::Header::new_gnu();
        // `set_path` refuses the names that hostile archives have.
        header.as_gnu_mut().expect("it is of this kind").name[..name.len()].copy_from_slice(name.as_bytes());
        header.set_size(bytes.len() as u64);
        header.set_mode(0o644);
        header.set_cksum();
        builder.append(&header, *bytes).expect("it can be appended");
    }
    builder.into_inner().expect("it can be finished")
}

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(bytes).expect("it can be written");
    encoder.finish().expect("it can be finished")
}

/// A folder with these files, taken in.
fn take_folder(files: &[(&str, &[u8])]) -> Intake {
    let folder = tempfile::tempdir().expect("a temporary folder");
    write_all(folder.path(), files);
    take(&[folder.path().to_owned()], &wanted(STARTER), None).expect("the folder is there")
}

fn write_all(folder: &Path, files: &[(&str, &[u8])]) {
    for (name, bytes) in files {
        let path = folder.join(name);
        std::fs::create_dir_all(path.parent().expect("it has one")).expect("it can be made");
        std::fs::write(path, bytes).expect("it can be written");
    }
}

fn code(intake: &Intake) -> &'static str {
    intake.outcome.as_ref().map_or_else(Refusal::code, |_| "ok")
}

fn notes(intake: &Intake) -> Vec<&'static str> {
    intake.notes.iter().map(Note::code).collect()
}

fn source(intake: &Intake) -> &str {
    &intake.outcome.as_ref().expect("it is taken").source
}

#[test]
fn the_source_is_found_wherever_it_lies() {
    let bytes = SOURCE.as_bytes();
    for name in ["render_pt.rs", "a b/ü ß/render_pt.rs", "🎨/مرحبا/render_pt.rs", "Render_PT.RS"] {
        let found = take_folder(&[(name, bytes), ("other.rs", b"fn main() {}"), ("a.png", b"\0\0")]);
        assert_eq!((source(&found), notes(&found)), (SOURCE, vec![]), "{name}");
        for archive in [("x.zip", zip(&[(name, bytes)])), ("x.tgz", gzip(&tar(&[(name, bytes)])))] {
            let found = take_folder(&[(archive.0, &archive.1)]);
            assert_eq!(source(&found), SOURCE, "{name} in {}", archive.0);
        }
    }
    let found = take_folder(&[("x.tar", &tar(&[("render_pt.rs", bytes)]))]);
    assert_eq!(source(&found), SOURCE);
}

#[test]
fn one_archive_in_another_is_opened_and_no_third() {
    let inner = zip(&[("p/render_pt.rs", SOURCE.as_bytes())]);
    let middle = gzip(&tar(&[("inner.zip", &inner)]));
    assert_eq!(source(&take_folder(&[("a.tar.gz", &middle)])), SOURCE);
    let outer = zip(&[("middle.tar.gz", &middle)]);
    assert_eq!(code(&take_folder(&[("a.zip", &outer)])), "nested-archive");
}

#[test]
fn what_cannot_be_graded_has_a_code() {
    let large = vec![b' '; (limits::SOURCE + 1) as usize];
    let cut = {
        let whole = zip(&[("render_pt.rs", SOURCE.as_bytes())]);
        whole[..whole.len() / 2].to_vec()
    };
    let cases: Vec<(&str, &str, Vec<u8>)> = vec![
        ("missing-file", "notes.txt", b"sorry".to_vec()),
        ("missing-file", "__MACOSX/render_pt.rs", SOURCE.into()),
        ("missing-file", "._render_pt.rs", SOURCE.into()),
        ("missing-file", "a.zip", zip(&[])),
        ("empty", "render_pt.rs", Vec::new()),
        ("empty", "render_pt.rs", b"\xef\xbb\xbf \r\n".to_vec()),
        ("too-large", "render_pt.rs", large.clone()),
        ("too-large", "a.zip", zip(&[("render_pt.rs", &large)])),
        ("nul-bytes", "render_pt.rs", b"fn main() {}\0".to_vec()),
        ("encoding", "render_pt.rs", b"\xff\xfea\0b".to_vec()),
        ("not-source", "render_pt.rs", b"PK\x03\x04word/document.xml".to_vec()),
        ("not-source", "render_pt.rs", b"%PDF-1.7".to_vec()),
        ("not-source", "render_pt.rs", b"{\\rtf1".to_vec()),
        ("not-source", "render_pt.rs", b"\xd0\xcf\x11\xe0".to_vec()),
        ("broken-archive", "a.zip", cut),
        ("broken-archive", "a.zip", Vec::new()),
        ("broken-archive", "a.tar.gz", b"\x1f\x8b\x08\0\0\0\0\0garbage".to_vec()),
        ("unsupported-archive", "a.rar", b"Rar!".to_vec()),
        ("outside-path", "a.zip", zip(&[("../render_pt.rs", SOURCE.as_bytes())])),
        ("outside-path", "a.tar", tar(&[("../../render_pt.rs", SOURCE.as_bytes())])),
        ("outside-path", "a.tar", tar(&[("/tmp/render_pt.rs", SOURCE.as_bytes())])),
        ("outside-path", "a.zip", zip(&[("C:\\render_pt.rs", SOURCE.as_bytes())])),
    ];
    for (expected, name, bytes) in cases {
        let intake = take_folder(&[(name, &bytes)]);
        assert_eq!(code(&intake), expected, "{name}: {:?}", intake.outcome);
    }
}

#[test]
fn where_the_source_is_missing_is_said_what_there_is() {
    let intake = take_folder(&[("src/main.rs", b"fn main() {}"), ("picture.png", b""), ("._x", b"")]);
    let refusal = intake.outcome.expect_err("there is no source").to_string();
    assert!(refusal.contains("main.rs") && refusal.contains("picture.png"), "{refusal}");
    assert!(!refusal.contains("._x"), "{refusal}");
}

#[test]
fn encrypted_archives_are_named() {
    let mut bytes = zip(&[("render_pt.rs", SOURCE.as_bytes())]);
    // The lowest bit of the flags says so, in the local header and in the directory.
    let directory = bytes.windows(4).position(|window| window == b"PK\x01\x02").expect("it has one");
    bytes[6] |= 1;
    bytes[directory + 8] |= 1;
    assert_eq!(code(&take_folder(&[("a.zip", &bytes)])), "encrypted");
}

#[test]
fn archives_that_unpack_to_too_much_are_not_read_to_their_end() {
    let zeros = vec![0; 64 << 20];
    for (name, bytes) in [
        ("a.tar.gz", gzip(&tar(&[("zeros", &zeros), ("render_pt.rs", SOURCE.as_bytes())]))),
        ("a.tgz", gzip(&tar(&[("render_pt.rs", SOURCE.as_bytes()), ("zeros", &zeros)]))),
    ] {
        let intake = take_folder(&[(name, &bytes)]);
        assert_eq!(code(&intake), "bomb", "{name}: {:?}", intake.outcome);
    }
    // Of a zip nothing is unpacked that is not wanted.
    let bytes = zip(&[("zeros", &zeros), ("render_pt.rs", SOURCE.as_bytes())]);
    assert_eq!(code(&take_folder(&[("a.zip", &bytes)])), "ok");
    let names: Vec<String> = (0..=limits::ENTRIES).map(|index| format!("{index}")).collect();
    let many: Vec<(&str, &[u8])> = names.iter().map(|name| (name.as_str(), &b""[..])).collect();
    assert_eq!(code(&take_folder(&[("a.zip", &zip(&many))])), "bomb");
}

#[test]
fn encodings_and_line_ends_cost_nobody_a_point() {
    let utf_16 = |little: bool| -> Vec<u8> {
        let units = "\u{feff}pub struct PathTracer;\n".encode_utf16();
        units.flat_map(|unit| if little { unit.to_le_bytes() } else { unit.to_be_bytes() }).collect()
    };
    for (bytes, expected, note) in [
        (b"\xef\xbb\xbfpub struct PathTracer;\n".to_vec(), SOURCE, "byte-order-mark"),
        (utf_16(true), SOURCE, "utf-16"),
        (utf_16(false), SOURCE, "utf-16"),
        (b"pub struct PathTracer;\r\n".to_vec(), SOURCE, "line-ends"),
        (b"// a\rpub struct PathTracer;\r".to_vec(), "// a\npub struct PathTracer;\n", "line-ends"),
        (b"// sch\xf6n \x80\n".to_vec(), "// schön €\n", "windows-1252"),
    ] {
        let intake = take_folder(&[("render_pt.rs", &bytes)]);
        assert_eq!((source(&intake), notes(&intake)), (expected, vec![note]));
    }
}

#[test]
fn of_several_sources_only_different_ones_are_a_question() {
    let other: &[u8] = b"pub struct PathTracer { a: u8 }";
    let same = take_folder(&[
        ("a/render_pt.rs", SOURCE.as_bytes()),
        ("b/render_pt.rs", SOURCE.replace('\n', "\r\n").as_bytes()),
    ]);
    assert_eq!((code(&same), notes(&same)), ("ok", vec!["copies"]));
    let different = take_folder(&[("a/render_pt.rs", SOURCE.as_bytes()), ("b/render_pt.rs", other)]);
    let refusal = different.outcome.expect_err("nobody knows which");
    assert_eq!(refusal.code(), "several-candidates");
    assert!(refusal.to_string().contains("render_pt.rs, b"), "{refusal}");
    // A student who sends the whole project, and the file once more beside it.
    let whole =
        take_folder(&[("arty/render_pt.rs", STARTER.as_bytes()), ("render_pt.rs", SOURCE.as_bytes())]);
    assert_eq!((source(&whole), notes(&whole)), (SOURCE, vec!["starter-too"]));
    // The same, but for a name that a browser has made of it.
    let renamed = take_folder(&[
        ("arty/render_pt.rs", STARTER.as_bytes()),
        ("arty/main.rs", b"use render_pt::PathTracer;"),
        ("render_pt (2).rs", SOURCE.as_bytes()),
    ]);
    assert_eq!((source(&renamed), notes(&renamed)), (SOURCE, vec!["starter-too", "other-name"]));
}

#[test]
fn the_untouched_starting_file_is_noted() {
    let intake = take_folder(&[("render_pt.rs", STARTER.replace('\n', "\r\n").as_bytes())]);
    assert_eq!((code(&intake), notes(&intake)), ("ok", vec!["line-ends", "untouched"]));
}

#[test]
fn a_renamed_source_is_taken_if_it_is_the_only_one() {
    for name in ["render_pt(1).rs", "render_pt.rs.txt", "Übung 5.rs"] {
        let intake = take_folder(&[(name, SOURCE.as_bytes()), ("helper.rs", b"fn f() {}")]);
        assert_eq!((source(&intake), notes(&intake)), (SOURCE, vec!["other-name"]), "{name}");
    }
}

#[test]
fn the_explanation_is_picked_up_and_the_projects_own_texts_are_not() {
    let pdf: &[u8] = b"%PDF-1.7 ...";
    let intake = take_folder(&[
        ("render_pt.rs", SOURCE.as_bytes()),
        ("Erklärung.txt", b"weil die Kan\xe4le"),
        ("5.2a.pdf", pdf),
        ("README.md", b"arty"),
    ]);
    let names: Vec<&str> = intake.explanations.iter().map(|explanation| explanation.name.as_str()).collect();
    assert_eq!(names, ["5.2a.pdf", "Erklärung.txt"]);
    assert_eq!(intake.explanations[0].hash, blake3::hash(pdf).to_hex().to_string());
    assert_eq!(intake.explanations[0].text, None);
    assert_eq!(intake.explanations[1].text.as_deref(), Some("weil die Kanäle"));
    let only_readme = take_folder(&[("render_pt.rs", SOURCE.as_bytes()), ("README.md", b"because")]);
    assert_eq!(only_readme.explanations.len(), 1);
}

#[test]
fn checksums_are_of_the_archive_and_of_the_source_as_they_were_sent() {
    let sent = SOURCE.replace('\n', "\r\n");
    let archive = zip(&[("render_pt.rs", sent.as_bytes())]);
    let intake = take_folder(&[("a.zip", &archive)]);
    assert_eq!(intake.checksums, [md5_of(&archive), md5_of(sent.as_bytes())]);
    assert_eq!(md5_of(b"hello world"), "5eb63bbbe01eeed093cb22bb8f5acdc3");
}

#[test]
#[cfg(unix)]
fn links_are_not_followed() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    write_all(folder.path(), &[("elsewhere/real.txt", SOURCE.as_bytes()), ("submission/notes.txt", b"")]);
    let submission = folder.path().join("submission");
    std::os::unix::fs::symlink("../elsewhere/real.txt", submission.join("render_pt.rs"))
        .expect("it can be made");
    std::os::unix::fs::symlink("..", submission.join("loop")).expect("it can be made");
    assert_eq!(code(&take(&[submission], &wanted(STARTER), None).expect("it is there")), "link");
}

fn git(folder: &Path, arguments: &[&str]) {
    let mut command = std::process::Command::new("git");
    command.args(["-c", "user.name=A", "-c", "user.email=a@example.org", "-c", "init.defaultBranch=main"]);
    let output = command.args(arguments).current_dir(folder).output().expect("git is installed");
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn of_a_repository_the_last_commit_counts_and_nothing_of_it_runs() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (work, bare) = (folder.path().join("work"), folder.path().join("bare.git"));
    write_all(&work, &[("src/render_pt.rs", SOURCE.as_bytes()), (".gitattributes", b"*.rs filter=evil\n")]);
    git(&work, &["init", "-q"]);
    assert_eq!(
        code(&take(std::slice::from_ref(&work), &wanted(STARTER), None).expect("it is there")),
        "git",
        "no commit yet"
    );
    git(&work, &["add", "."]);
    git(&work, &["commit", "-qm", "one"]);
    git(folder.path(), &["clone", "-q", "--bare", "work", "bare.git"]);
    let proof = folder.path().join("it-ran");
    let evil = format!("touch '{}'", proof.display());
    for key in ["filter.evil.smudge", "filter.evil.clean", "core.fsmonitor", "core.pager", "core.sshCommand"]
    {
        git(&work, &["config", key, &evil]);
    }
    write_all(&work, &[("src/render_pt.rs", b"changed")]);
    let checkout = take(&[work], &wanted(STARTER), None).expect("it is there");
    assert_eq!((source(&checkout), notes(&checkout)), (SOURCE, vec!["uncommitted"]));
    assert!(!proof.exists(), "a program of the repository ran");
    let from_bare = take(std::slice::from_ref(&bare), &wanted(STARTER), None).expect("it is there");
    assert_eq!((source(&from_bare), notes(&from_bare)), (SOURCE, vec![]));
    write_all(&bare, &[("objects/info/alternates", b"/elsewhere\n")]);
    assert_eq!(code(&take(&[bare], &wanted(STARTER), None).expect("it is there")), "git");
}
