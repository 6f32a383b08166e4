//! Submissions that are meant to cost, to mislead or to break: each ends with a code, in little time, with little data.

mod archives;

use std::path::{Path, PathBuf};
use std::time::Duration;

use archives::{Entry, SOURCE, gzip, long_name, overlapping, tar, tar_header, zip};
use cpu_time::ThreadTime;
use intake::{Intake, Refusal, Wanted, limits, take, take_bytes};
use tar::EntryType;

/// Processor time that any of them may take. These tests are not optimised: the grader needs a fraction of it.
const MAX_TIME: Duration = Duration::from_secs(limits::SECONDS + 2);
/// Maximum size in bytes of all texts and names that remain of any of them.
const MAX_SIZE: usize = 8 << 20;

fn wanted() -> Wanted {
    let [file_name, type_name, starter] = ["render_pt.rs", "PathTracer", ""].map(str::to_owned);
    Wanted { file_name, type_name, starter }
}

/// The code of an outcome, after a look at what it has cost.
fn code_of(what: &str, make: impl FnOnce() -> Intake) -> &'static str {
    let start = ThreadTime::now();
    let intake = make();
    let time = start.elapsed();
    assert!(time < MAX_TIME, "{what}: {time:?}");
    let size = format!("{:?} {:?} {:?}", intake.outcome, intake.notes, intake.explanations).len();
    assert!(size < MAX_SIZE, "{what}: {size} bytes");
    for explanation in &intake.explanations {
        assert!(!explanation.name.chars().any(char::is_control), "{what}: {:?}", explanation.name);
    }
    let findings = intake.notes.iter().map(ToString::to_string);
    for text in findings.chain(intake.outcome.as_ref().err().map(ToString::to_string)) {
        assert!(!text.chars().any(|c| c.is_control() || c == '\u{202e}'), "{what}: {text:?}");
        assert!(text.chars().count() < 2_000, "{what}: {} characters", text.chars().count());
    }
    intake.outcome.as_ref().map_or_else(Refusal::code, |_| "ok")
}

fn code_of_bytes(name: &str, bytes: &[u8]) -> &'static str {
    code_of(name, || take_bytes(name, bytes, &wanted()))
}

fn code_of_path(path: &Path) -> &'static str {
    code_of("path", || take(&[path.to_owned()], &wanted(), None).expect("it exists"))
}

#[test]
fn bombs_are_not_unpacked() {
    let (text, source) = (vec![b'a'; 15 << 20], vec![b' '; 500 << 10]);
    let inner = {
        let mut entries = vec![Entry::new("render_pt.rs", &source)];
        entries.extend((0..20).map(|index| Entry::new(format!("e{index}.txt"), &text[..1 << 20])));
        zip(&entries)
    };
    let nested: Vec<Entry> = (0..200).map(|index| Entry::new(format!("{index}.zip"), &inner)).collect();
    let dense: Vec<u8> = (0..1_u32 << 20)
        .map(|at: u32| if at % 1408 < 8 { (at.wrapping_mul(2_654_435_761) >> 24) as u8 } else { b'a' })
        .collect();
    for (expected, name, bytes) in [
        (
            "bomb",
            "sources.zip",
            overlapping((0..19_000).map(|index| format!("{index}/render_pt.rs")), &source),
        ),
        ("missing-file", "texts.zip", overlapping((0..60).map(|index| format!("e{index}.txt")), &text)),
        ("bomb", "nested.zip", zip(&nested)),
        ("bomb", "million.zip", overlapping((0..1_000_000).map(|_| "a".to_owned()), b"")),
        (
            "broken-archive",
            "names.zip",
            overlapping((0..19_000).map(|index| format!("{index}{}", "a".repeat(5_000))), b""),
        ),
        ("bomb", "long.tar.gz", long_name(EntryType::GNULongName, 40, &[b'a'; 1 << 20])),
        ("bomb", "pax.tar.gz", long_name(EntryType::XHeader, 40, &[b'a'; 1 << 20])),
        ("bomb", "dense.tar.gz", long_name(EntryType::GNULongName, 64, &dense)),
        ("missing-file", "members.tar.gz", gzip(b"").repeat(200_000)),
    ] {
        assert_eq!(code_of_bytes(name, &bytes), expected, "{name}");
    }
    let many: Vec<_> = (0..21_000).map(|_| (tar_header(b"d", 0, EntryType::Regular), &b""[..])).collect();
    assert_eq!(code_of_bytes("many.tar.gz", &gzip(&tar(&many))), "bomb");
}

#[test]
fn nothing_in_an_archive_is_believed() {
    let mut quine = zip(&[Entry::new("render_pt.rs", SOURCE)]);
    for _ in 0..40 {
        quine = zip(&[Entry::new("n.zip", &quine)]);
    }
    let good = zip(&[Entry::new("render_pt.rs", SOURCE)]);
    let changed = |at: &[u8], offset: usize, value: &[u8]| {
        let mut bytes = good.clone();
        let start = bytes.windows(at.len()).rposition(|window| window == at).expect("it is there") + offset;
        bytes[start..start + value.len()].copy_from_slice(value);
        bytes
    };
    let two_ends = {
        let mut bytes = good.clone();
        let end = bytes.len();
        bytes[end - 2] = 22;
        bytes.extend(b"PK\x05\x06");
        bytes.extend([0; 18]);
        bytes
    };
    let link = Entry { mode: 0o120_777, method: 0, ..Entry::new("render_pt.rs", b"/etc/passwd") };
    let method = |method| zip(&[Entry { method, ..Entry::new("render_pt.rs", SOURCE) }]);
    let twice =
        [Entry::new("render_pt.rs", SOURCE), Entry::new("render_pt.rs", b"pub struct PathTracer(u8);")];
    let prefixed = [b"#!/bin/sh\n", &good[..]].concat();
    for (expected, name, bytes) in [
        (&["nested-archive"][..], "quine.zip", quine),
        (&["broken-archive", "ok"], "count_lies.zip", changed(b"PK\x05\x06", 8, &[255; 4])),
        (&["broken-archive"], "offset_lies.zip", changed(b"PK\x05\x06", 16, &[0xf0, 255, 255, 255])),
        (&["ok", "broken-archive"], "size_lies.zip", changed(b"PK\x01\x02", 24, &[254, 255, 255, 255])),
        (&["missing-file", "ok", "broken-archive"], "two_ends.zip", two_ends),
        (&["link"], "link.zip", zip(&[link])),
        (&["unsupported-archive"], "lzma.zip", method(14)),
        (&["unsupported-archive"], "bzip2.zip", method(12)),
        (&["unsupported-archive"], "aes.zip", method(99)),
        (&["ok"], "stored.zip", method(0)),
        (&["duplicate-entry"], "twice.zip", zip(&twice)),
        (&["broken-archive", "ok"], "prefixed.zip", prefixed),
    ] {
        let code = code_of_bytes(name, &bytes);
        assert!(expected.contains(&code), "{name}: {code}");
    }
    assert_eq!(code_of_bytes("render_pt.rs", &good), "not-source");
}

#[test]
fn names_in_archives_lead_nowhere_and_reach_no_terminal() {
    for (expected, name) in [
        ("outside-path", "/render_pt.rs".to_owned()),
        ("outside-path", "../render_pt.rs".to_owned()),
        ("outside-path", "a/../../render_pt.rs".to_owned()),
        ("outside-path", "..\\render_pt.rs".to_owned()),
        ("outside-path", "\\\\srv\\x\\render_pt.rs".to_owned()),
        ("ok", "./render_pt.rs".to_owned()),
        ("ok", "a//render_pt.rs".to_owned()),
        ("ok", "RENDER_PT.RS".to_owned()),
        ("ok", "CON/render_pt.rs".to_owned()),
        ("ok", "\u{1b}[2J\u{1b}]0;x\u{7}/render_pt.rs".to_owned()),
        ("ok", "a\nb/\u{202e}/render_pt.rs".to_owned()),
        ("broken-archive", format!("{}/render_pt.rs", "a".repeat(65_000))),
        ("missing-file", "render_pt.rs.".to_owned()),
        ("missing-file", "render_pt.rs\0.png".to_owned()),
        ("missing-file", "re\u{1b}[31mnder_pt.r\u{202e}s".to_owned()),
        ("missing-file", "nul".to_owned()),
    ] {
        let alone = zip(&[Entry::new(&name, SOURCE)]);
        assert_eq!(code_of_bytes("a.zip", &alone), expected, "{}", name.escape_debug());
        // Beside another source, the names are in a message.
        let other = Entry::new("x/render_pt.rs", b"pub struct PathTracer(u8);");
        code_of_bytes("a.zip", &zip(&[Entry::new(&name, SOURCE), other]));
        let text = format!("{name}\u{1b}[2J\u{202e}.txt");
        code_of_bytes("a.zip", &zip(&[Entry::new(text, b"because\x1b[2J")]));
    }
}

#[test]
fn tars_hold_files_only() {
    let header = |name: &str, size, kind| tar_header(name.as_bytes(), size, kind);
    let mut link = header("render_pt.rs", 0, EntryType::Symlink);
    link.set_link_name("/etc/shadow").expect("it fits");
    link.set_cksum();
    let mut hard = header("render_pt.rs", 0, EntryType::Link);
    hard.set_link_name("a.txt").expect("it fits");
    hard.set_cksum();
    let length = SOURCE.len() as u64;
    let other = b"pub struct PathTracer(u8);";
    let twice = [
        (header("render_pt.rs", length, EntryType::Regular), SOURCE),
        (header("render_pt.rs", other.len() as u64, EntryType::Regular), &other[..]),
    ];
    let long = format!("{}/render_pt.rs", "d".repeat(300));
    let pax = format!("{} path={long}\n", long.len() + 10);
    let named = |kind, name: &str| {
        let long = (header("L", name.len() as u64, kind), name.as_bytes());
        tar(&[long, (header("x", length, EntryType::Regular), SOURCE)])
    };
    for (expected, bytes) in [
        ("missing-file", tar(&[(header("render_pt.rs", 0, EntryType::Char), b"")])),
        ("missing-file", tar(&[(header("render_pt.rs", 0, EntryType::Fifo), b"")])),
        ("link", tar(&[(link, b"")])),
        ("link", tar(&[(hard, b"")])),
        ("outside-path", tar(&[(header("/tmp/render_pt.rs", length, EntryType::Regular), SOURCE)])),
        ("broken-archive", tar(&[(header("render_pt.rs", 8 << 30, EntryType::Regular), SOURCE)])),
        ("duplicate-entry", tar(&twice)),
        ("ok", named(EntryType::GNULongName, &long)),
        ("ok", named(EntryType::XHeader, &pax)),
        ("outside-path", named(EntryType::GNULongName, "../render_pt.rs\0")),
    ] {
        let code = code_of_bytes("a.tar", &bytes);
        assert!(code == expected, "{expected}: {code}");
        assert_eq!(code_of_bytes("a.tar.gz", &gzip(&bytes)), code);
    }
}

#[test]
#[cfg(unix)]
fn links_and_pipes_at_the_top_are_findings() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = |name: &str| -> PathBuf { folder.path().join(name) };
    std::fs::write(path("secret.rs"), SOURCE).expect("it can be written");
    std::fs::create_dir(path("others")).expect("it can be made");
    std::fs::write(path("others/render_pt.rs"), SOURCE).expect("it can be written");
    for (link, target) in
        [("render_pt.rs", "secret.rs"), ("folder", "others"), ("loop", "loop"), ("a.zip", "secret.rs")]
    {
        std::os::unix::fs::symlink(path(target), path(link)).expect("it can be made");
        assert_eq!(code_of_path(&path(link)), "link", "{link}");
    }
    assert!(
        std::process::Command::new("mkfifo").arg(path("pipe")).status().expect("it is installed").success()
    );
    assert_eq!(code_of_path(&path("pipe")), "no-file");
}

/// A git repository with the source in its last commit.
#[cfg(unix)]
fn repository(folder: &Path) {
    std::fs::write(folder.join("render_pt.rs"), SOURCE).expect("it can be written");
    for arguments in [
        &["init", "-q", "-b", "main"][..],
        &["add", "."],
        &["-c", "user.name=A", "-c", "user.email=a@example.org", "commit", "-qm", "one"],
    ] {
        git(folder, arguments);
    }
    std::fs::remove_file(folder.join("render_pt.rs")).expect("it can be removed");
    assert_eq!(code_of_path(folder), "ok");
}

#[cfg(unix)]
fn git(folder: &Path, arguments: &[&str]) -> String {
    let output = std::process::Command::new("git").args(arguments).current_dir(folder).output();
    let output = output.expect("git is installed");
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8_lossy(&output.stdout).trim().to_owned()
}

#[test]
#[cfg(unix)]
fn a_repository_makes_nobody_wait_and_borrows_nothing() {
    for (expected, attack) in [
        ("missing-file", "mkfifo x; rm .git/HEAD; mkfifo .git/HEAD"),
        ("ok", "printf '[include]\\n\\tpath = /dev/tty\\n' >> .git/config"),
        ("ok", "rm .git/config; mkfifo .git/config"),
        ("git", "rm .git/refs/heads/main; mkfifo .git/refs/heads/main"),
        ("git", "for f in .git/objects/??/*; do rm -f $f; mkfifo $f; done"),
        (
            "git",
            "mv .git/objects ../objects; mkdir .git/objects; for f in ../objects/??; do ln -s $PWD/$f .git/objects/; done",
        ),
        ("git", "echo ref: ../../other > .git/HEAD"),
        ("git", "echo ref: refs/heads/main > .git/refs/heads/main"),
        ("git", "echo /elsewhere > .git/objects/info/alternates"),
        ("git", "for f in .git/objects/??/*; do chmod u+w $f; : > $f; done"),
        ("ok", "git gc -q; mkfifo .git/objects/pack/a.idx .git/objects/pack/a.pack"),
        (
            "git",
            "git gc -q; chmod -R u+w .git; for f in .git/objects/pack/*; do head -c 3000 /dev/zero > $f; done",
        ),
    ] {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let work = folder.path().join("work");
        std::fs::create_dir(&work).expect("it can be made");
        repository(&work);
        let status = std::process::Command::new("sh").args(["-ec", attack]).current_dir(&work).status();
        assert!(status.expect("there is a shell").success(), "{attack}");
        assert_eq!(code_of_path(&work), expected, "{attack}");
    }
}

#[test]
#[cfg(unix)]
fn packs_are_read_as_git_reads_them() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    repository(folder.path());
    let mut text = String::from_utf8_lossy(SOURCE).into_owned();
    // Versions of a long file, which git stores as differences.
    for version in 0..40 {
        text = format!("// {version}\n{text}{}", "let there = light;\n".repeat(50 + version));
        std::fs::write(folder.path().join("render_pt.rs"), &text).expect("it can be written");
        let name = ["-c", "user.name=A", "-c", "user.email=a@example.org"];
        git(folder.path(), &[&name[..], &["commit", "-qam", "next"]].concat());
    }
    git(folder.path(), &["gc", "-q", "--aggressive"]);
    for branch in ["main", "HEAD~20", "HEAD~39"] {
        git(folder.path(), &["checkout", "-q", branch]);
        let expected = git(folder.path(), &["show", "HEAD:render_pt.rs"]);
        let intake = take(&[folder.path().to_owned()], &wanted(), None).expect("it exists");
        assert_eq!(intake.outcome.expect("there is one").source.trim(), expected, "{branch}");
        git(folder.path(), &["checkout", "-q", "main"]);
    }
}

#[test]
#[cfg(unix)]
fn a_tree_of_trees_is_no_forest() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let script = "git init -q -b main; b=$(git hash-object -w --stdin < source)
        t=$(printf '100644 blob %s\\trender_pt.rs\\n' $b | git mktree)
        for i in 1 2 3 4 5 6; do t=$(for j in a b c d e f g h i j; do printf '040000 tree %s\\t%s\\n' $t $j; done | git mktree); done
        git update-ref refs/heads/main $(git -c user.name=a -c user.email=a@b commit-tree $t -m x); rm source";
    std::fs::write(folder.path().join("source"), "// x\n".repeat(100_000)).expect("it can be written");
    let status = std::process::Command::new("sh").args(["-ec", script]).current_dir(folder.path()).status();
    assert!(status.expect("there is a shell").success());
    assert_eq!(code_of_path(folder.path()), "bomb");
}
