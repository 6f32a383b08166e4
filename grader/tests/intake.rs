//! Submissions are read in a process that has locked itself in.

#[path = "../intake/tests/archives/mod.rs"]
mod archives;

use std::path::{Path, PathBuf};

use archives::{Entry, SOURCE, gzip, long_name, overlapping, zip};
use intake::{Intake, Reader, Refusal, Wanted};
use verdict::error::Error;

fn wanted() -> Wanted {
    let [file_name, type_name, starter] = ["render_pt.rs", "PathTracer", ""].map(str::to_owned);
    Wanted { file_name, type_name, starter }
}

fn apart() -> Reader {
    Reader::Apart(PathBuf::from(env!("CARGO_BIN_EXE_grader")))
}

fn code(intake: &Intake) -> &'static str {
    intake.outcome.as_ref().map_or_else(Refusal::code, |_| "ok")
}

#[test]
fn a_process_of_its_own_reads_what_this_one_reads() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let texts = overlapping((0..60).map(|index| format!("e{index}.txt")), &vec![b'a'; 15 << 20]);
    let other: &[u8] = b"pub struct PathTracer(u8);";
    let both = zip(&[Entry::new("a/render_pt.rs", SOURCE), Entry::new("b/render_pt.rs", other)]);
    for (name, expected, source, bytes) in [
        ("render_pt.rs", "ok", None, SOURCE.to_vec()),
        ("a b ü.zip", "ok", None, zip(&[Entry::new("render_pt.rs", SOURCE), Entry::new("why.txt", b"so")])),
        ("both.zip", "several-candidates", None, both.clone()),
        ("one.zip", "ok", Some("b/render_pt.rs"), both),
        ("texts.zip", "missing-file", None, texts),
        ("long.tar.gz", "bomb", None, long_name(tar::EntryType::GNULongName, 40, &[b'a'; 1 << 20])),
        ("members.tar.gz", "missing-file", None, gzip(b"").repeat(100_000)),
        ("--source=x", "missing-file", None, b"\x89PNG".to_vec()),
    ] {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).expect("it can be written");
        let paths = [path];
        let here = Reader::Here.take(&paths, &wanted(), source).expect("it is there");
        let there = apart().take(&paths, &wanted(), source).expect("it is there");
        assert_eq!((code(&here), code(&there)), (expected, expected), "{name}");
        assert_eq!(format!("{here:?}"), format!("{there:?}"), "{name}");
    }
}

/// A program in place of the grader.
#[cfg(unix)]
fn impostor(folder: &Path, script: &str) -> Reader {
    use std::os::unix::fs::PermissionsExt;
    let path = folder.join("impostor");
    std::fs::write(&path, format!("#!/bin/sh\n{script}\n")).expect("it can be written");
    std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o755)).expect("it is ours");
    Reader::Apart(path)
}

#[test]
#[cfg(unix)]
fn whatever_happens_to_the_process_is_a_finding() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let submission = [folder.path().join("render_pt.rs")];
    std::fs::write(&submission[0], SOURCE).expect("it can be written");
    for (expected, script) in [
        ("bomb", "kill -9 $$"),
        ("bomb", "kill -6 $$"),
        ("intake-failed", "exit 101"),
        ("intake-failed", "echo {; exit 0"),
        ("intake-failed", "cat /dev/zero | head -c 100000000; exit 0"),
    ] {
        let intake =
            impostor(folder.path(), script).take(&submission, &wanted(), None).expect("it can be started");
        assert_eq!(code(&intake), expected, "{script}");
    }
    let missing = Reader::Apart(folder.path().join("missing")).take(&submission, &wanted(), None);
    assert!(matches!(missing, Err(Error::Harness(_))), "{missing:?}");
    let nothing = apart().take(&[folder.path().join("nothing")], &wanted(), None);
    assert!(matches!(nothing, Err(Error::Input(_))), "{nothing:?}");
}
