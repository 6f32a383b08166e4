//! Similar submissions: earlier years, the page with sources side by side, and the layout of other programs.

use std::collections::BTreeMap;
use std::path::Path;

use crate::course::{Course, solution, stderr};

/// A submission that is compared, but costs no grade: it does not compile.
fn broken(source: &str) -> String {
    format!("{source}\nfn broken() -> u32 {{ \"\" }}\n")
}

/// All files below a folder, with their content.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in std::fs::read_dir(folder).expect("it can be listed").flatten() {
        let path = entry.path();
        if path.is_dir() {
            found.extend(files(&path));
        } else {
            found.insert(path.display().to_string(), std::fs::read(&path).expect("it can be read"));
        }
    }
    found
}

#[test]
fn a_copy_of_an_earlier_year_is_found_and_shown_side_by_side() {
    let copied = broken(&solution());
    let disguised = broken(&solution().replace("balance(", "heuristic(").replace('{', "{ // mine\n"));
    let course = Course::new(&[("ann/render_pt.rs", &copied), ("ben.rs", &broken("fn other() {}"))]);
    course.run(&["--out=2025"]);
    std::fs::remove_dir_all(course.path("class")).expect("it can be removed");
    course.write("class/bob/render_pt.rs", &disguised);
    course.write("class/cem/render_pt.rs", &broken("fn nothing() {}"));
    course.write("roster.csv", "login,Name\nbob,=Bob Ray\ncem,Cem Öz\n");
    course.write("received.csv", "student,received_at\nbob,2026-05-21 12:00\n");
    course.run(&["--roster=roster.csv", "--manifest=received.csv", "--out=2026"]);
    assert!(course.read("2026/similar.txt").contains("none"), "it is alone in its year");

    let here = course.path("rubric").display().to_string();
    assert!(
        !course.read("2025/fingerprints.json").contains(&here),
        "another year's rubric may lie elsewhere"
    );
    let before = files(&course.path("2025"));
    let output = course.other(&["similar", "--out=2026", "--earlier=2025", "--export=other-programs"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let told = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(told.contains("the same except for names, comments and layout: bob, 2025/ann"), "{told}");
    assert_eq!(files(&course.path("2025")), before, "an archive is only read");
    let page = course.read("2026/similar.html");
    assert!(page.contains("bob – 2025/ann: 100 % in common") && page.contains("<mark>"), "{page}");

    // The layout of JPlag: files of submissions in one folder, what all have in common in another. That of Dolos: a table
    // that names the files.
    let info = course.read("other-programs/info.csv");
    let expected = "filename,full_name,label,created_at\nsubmissions/bob.rs,'=Bob Ray,,2026-05-21 10:00:00 +0000\n\
                    submissions/cem.rs,Cem Öz,,\n";
    assert_eq!(info, expected);
    assert_eq!(course.read("other-programs/submissions/bob.rs"), disguised);
    assert!(course.read("other-programs/base/starter.rs").contains("PathTracer"));

    // Fingerprints alone are enough to find it, but not to show it.
    std::fs::rename(course.path("2025/fingerprints.json"), course.path("kept.json")).expect("it is there");
    let output = course.other(&["similar", "--out=2026", "--earlier=kept.json"]);
    assert!(String::from_utf8_lossy(&output.stdout).contains("bob, kept/ann"), "{}", stderr(&output));
    assert!(course.read("2026/similar.html").contains("only its fingerprints are known"));
    course.write(
        "foreign.json",
        &course.read("kept.json").replace("\"assignment\"", "\"assignment\": \"x\", \"was\""),
    );
    for (arguments, expected) in [
        (["--earlier=foreign.json", "--export=new"], "not of"),
        (["--earlier=2025", "--export=new"], "fingerprints.json"),
        (["--earlier=kept.json", "--export=other-programs"], "not empty"),
    ] {
        let output = course.other(&[&["similar", "--out=2026"], &arguments[..]].concat());
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(expected), "{arguments:?}: {}", stderr(&output));
    }
}
