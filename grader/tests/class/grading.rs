//! Grading, resuming and regrading a class, penalties, and the tables of course systems.

use std::collections::BTreeMap;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::course::{Course, solution, starter, stderr, that_does};

fn mixed() -> Course {
    let (solution, starter) = (solution(), starter());
    let course = Course::new(&[
        ("ann/render_pt.rs", &solution),
        ("bob/src/render_pt.rs", &starter),
        ("cem.rs", "fn main( {"),
        ("dan/render_pt.rs", &that_does("panic!(\"=1+1\")")),
        ("eve/render_pt.rs", &that_does("std::process::exit(0)")),
        ("fay/notes.txt", "sorry"),
        ("gus/render_pt.rs", &solution.replace("balance(", "heuristic(")),
        ("=hal()/render_pt.rs", &solution.replace("0.95", "0.9")),
    ]);
    course.write(
        "roster.csv",
        "login;Vorname;Nachname\nzoe;=Zoe;Z\nann;Ann;A\nbob;Bob;B\ncem;Cem;C\ndan;Dan;D\neve;Eve;E\nfay;Fay;F\ngus;Gus;G\n",
    );
    course
}

#[test]
fn every_submission_has_a_row_and_costs_nobody_else_anything_whatever_the_order_and_number_of_jobs() {
    let course = mixed();
    course.run(&["--roster=roster.csv", "--allow-unknown", "--out=one", "--jobs=1"]);
    let row = |state: &str, reason: &str, points: f64| (state.to_owned(), reason.to_owned(), Some(points));
    let expected = BTreeMap::from(
        [
            ("ann", row("graded", "", 10.0)),
            ("bob", row("graded", "", 0.0)),
            ("cem", row("graded", "build", 0.0)),
            ("dan", row("graded", "crash", 0.0)),
            ("eve", row("graded", "crash", 0.0)),
            ("fay", row("refused", "missing-file", 0.0)),
            ("gus", row("graded", "", 10.0)),
            ("hal", row("graded", "", 10.0)),
            ("zoe", row("missing", "missing", 0.0)),
        ]
        .map(|(key, row)| (key.to_owned(), row)),
    );
    assert_eq!(course.results("one"), expected);

    // Another roster is another order; unknown ones come last in both.
    let roster = std::fs::read_to_string(course.path("roster.csv")).expect("it is there");
    let (header, students) = roster.split_once('\n').expect("it has lines");
    let reversed: Vec<&str> = students.lines().rev().collect();
    course.write("reversed.csv", &format!("{header}\n{}\n", reversed.join("\n")));
    course.run(&["--roster=reversed.csv", "--allow-unknown", "--out=three", "--jobs=3"]);
    assert_eq!(course.results("three"), expected);
    let verdicts = |out: &str| -> BTreeMap<String, Value> {
        course
            .records(out)
            .into_iter()
            .map(|path| {
                let record: Value =
                    serde_json::from_slice(&std::fs::read(&path).expect("it is there")).expect("it is JSON");
                let name = path.parent().expect("it has one").file_name().expect("it has one");
                (name.to_string_lossy().into_owned(), record["checks"].clone())
            })
            .collect()
    };
    assert_eq!(verdicts("one"), verdicts("three"));

    let gradebook = std::fs::read_to_string(course.path("one/gradebook.csv")).expect("it is there");
    assert!(gradebook.contains(",'=Zoe,") && gradebook.contains("'=hal()"), "{gradebook}");
    let similar = std::fs::read_to_string(course.path("one/similar.txt")).expect("it is there");
    assert!(similar.contains("names, comments and layout: ann, gus"), "{similar}");
    let students = std::fs::read_to_string(course.path("one/submissions/ann/record.json"))
        .expect("it is there")
        + &std::fs::read_to_string(course.path("one/submissions/ann/report.json")).expect("it is there");
    assert!(!students.contains("gus") && !students.contains("similar"), "a student sees nothing of others");
}

#[test]
fn what_was_killed_goes_on_where_it_was() {
    let solution = solution();
    let sources: Vec<(String, String)> =
        (0..6).map(|index| (format!("s{index}/render_pt.rs"), format!("// {index}\n{solution}"))).collect();
    let submissions: Vec<(&str, &str)> =
        sources.iter().map(|(name, source)| (name.as_str(), source.as_str())).collect();
    let course = Course::new(&submissions);
    let mut child = course
        .command(&["--out=out", "--jobs=1"])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the program starts");
    let start = Instant::now();
    while course.records("out").len() < 2 {
        assert!(start.elapsed() < Duration::from_secs(300), "nothing is written while it runs");
        assert!(child.try_wait().expect("it can be asked").is_none(), "it ended before it could be killed");
        std::thread::sleep(Duration::from_millis(5));
    }
    child.kill().expect("it can be killed");
    child.wait().expect("it has ended");
    let kept = course.records("out").len();
    assert!((2..6).contains(&kept), "{kept} of 6 before it was killed");
    // What was being written is no result.
    course.write("out/submissions/s5/record.json", "{\"schema\": \"arty-rec");

    let refused = course.command(&["--out=out"]).output().expect("the program starts");
    assert_eq!(refused.status.code(), Some(2), "it must be told what to do with earlier results");
    assert!(stderr(&refused).contains("--resume"), "{}", stderr(&refused));

    let told = course.run(&["--out=out", "--resume", "--jobs=2"]);
    assert!(told.contains(&format!("{} graded now, {kept} unchanged", 6 - kept)), "{told}");
    assert!(course.results("out").values().all(|(_, _, points)| *points == Some(10.0)));

    // A new submission, a changed one and another seed are graded; others are not.
    course.write("class/s0/render_pt.rs", &starter());
    course.write("class/s6.rs", &solution);
    let told = course.run(&["--out=out", "--resume"]);
    assert!(told.contains("2 graded now, 5 unchanged"), "{told}");
    assert!(told.contains("s0: 1 10 → 0"), "{told}");
    let told = course.run(&["--out=out", "--resume", "--seed=2"]);
    assert!(told.contains("7 graded now, 0 unchanged"), "{told}");
}

#[test]
fn regrading_says_what_has_changed_and_a_fault_of_the_machine_costs_nobody_a_score() {
    let course = Course::new(&[("ann/render_pt.rs", &solution()), ("bob/render_pt.rs", &starter())]);
    course.run(&["--out=out"]);
    assert!(course.run(&["--out=out", "--regrade"]).contains("0 of 2 scores changed"));
    let record = course.path("out/submissions/bob/record.json");
    let text = std::fs::read_to_string(&record).expect("it is there");
    std::fs::write(&record, text.replace("\"1\": 0.0", "\"1\": 4.0")).expect("it can be written");
    let told = course.run(&["--out=out", "--regrade"]);
    assert!(told.contains("1 of 2 scores changed\n  bob: 1 4 → 0"), "{told}");

    #[cfg(unix)]
    {
        // Without a linker nothing compiles; cargo and rustc are found all the same.
        let tools = course.path("tools");
        std::fs::create_dir(&tools).expect("it can be made");
        for (tool, variable) in [("cargo", "CARGO"), ("rustc", "RUSTC")] {
            let found = std::env::var(variable).unwrap_or_else(|_| which(tool));
            std::os::unix::fs::symlink(found, tools.join(tool)).expect("it can be linked");
        }
        let mut command = course.command(&["--out=out", "--regrade"]);
        let output = command.env("PATH", &tools).output().expect("the program starts");
        // That is found with an empty submission: no result is touched.
        assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
        assert!(stderr(&output).contains("not even an empty submission compiles"), "{}", stderr(&output));
        let kept = course.results("out");
        assert_eq!(kept["ann"], ("graded".to_owned(), String::new(), Some(10.0)));
    }
}

/// The first program of that name in the search path.
#[cfg(unix)]
fn which(tool: &str) -> String {
    let path = std::env::var_os("PATH").expect("there is a search path");
    let found = std::env::split_paths(&path).map(|folder| folder.join(tool)).find(|file| file.is_file());
    found.expect("the tool is installed").display().to_string()
}

#[test]
fn penalties_follow_the_policy_without_grading_again_and_reach_the_course_systems() {
    let solution = solution();
    let course = Course::new(&[
        ("Ann Lee_11_assignsubmission_file_/render_pt.rs", &solution),
        ("Bob Ray_12_assignsubmission_file_/render_pt.rs", &solution),
        ("Cem Öz_13_assignsubmission_file_/render_pt.rs", &solution),
        ("Cem Öz_13_assignsubmission_file_/first/render_pt.rs", &solution),
    ]);
    course.write(
        "moodle.csv",
        "\u{feff}Identifier,\"Full name\",\"Email address\",Status,Grade,\"Maximum Grade\",\"Grade can be changed\",\"Feedback comments\",Group\n\
         Participant 11,Ann Lee,al@x.org,Submitted,,\"10,00\",Yes,,=A\n\
         Participant 12,Bob Ray,br@x.org,Submitted,,\"10,00\",Yes,,B\n\
         Participant 13,Cem Öz,co@x.org,Submitted,,\"10,00\",No,,B\n\
         Participant 14,Dee Poe,dp@x.org,No submission,,\"10,00\",Yes,,B\n",
    );
    course.write("course.yml", "deadline: 2026-05-21 23:59\n");
    course.write(
        "received.csv",
        "student,received_at\nal@x.org,2026-05-22 01:00\n12,2026-05-22 02:00\nco@x.org,2026-05-21 20:00\n",
    );
    let arguments = ["--moodle=moodle.csv", "--manifest=received.csv", "--course=course.yml", "--out=out"];
    course.run(&arguments);
    let points = |key: &str| course.results("out")[key].clone();
    assert_eq!(points("al@x.org").2, Some(8.0));
    assert_eq!((points("br@x.org").1.as_str(), points("br@x.org").2), ("late", Some(0.0)));
    assert_eq!(points("co@x.org").2, Some(10.0));
    let filled = std::fs::read_to_string(course.path("out/moodle.csv")).expect("it is there");
    let lines: Vec<&str> = filled.lines().collect();
    assert!(lines[0].starts_with("\u{feff}Identifier,Full name"), "{filled}");
    assert!(lines[1].contains(",8,\"10,00\",Yes,1: 10; 1 h 01 min 00 s late: × 0.8,=A"), "{filled}");
    assert!(
        lines[2].contains(",0,\"10,00\",Yes,\"1: 10; late: not accepted")
            || lines[2].contains(",0,\"10,00\",Yes,1: 10; late: not accepted"),
        "{filled}"
    );
    assert!(lines[3].contains("Submitted,,\"10,00\",No,,B"), "it may not be changed: {filled}");
    assert!(lines[4].contains("No submission,,\"10,00\",Yes,,B"), "nothing was handed in: {filled}");

    // The deadline is moved: other points, from the same verdicts.
    course.write(
        "course.yml",
        "deadline: 2026-05-22 00:30\nextensions:\n- { student: br@x.org, until: 2026-05-23 12:00, reason: ill }\n",
    );
    let told = course.run(&[&arguments[..], &["--resume"]].concat());
    assert!(told.contains("0 graded now, 3 unchanged"), "{told}");
    assert_eq!((points("al@x.org").2, points("br@x.org").2), (Some(8.0), Some(10.0)));

    course.write("received.csv", "student,received_at\nnobody,2026-05-22 01:00\n");
    let output = course.command(&[&arguments[..], &["--resume"]].concat()).output().expect("it starts");
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("`nobody`"), "{}", stderr(&output));
}

#[test]
fn ilias_is_told_by_number_and_of_several_submissions_the_last_accepted_counts() {
    let course = Course::new(&[
        ("Ex/Sheet/Lee_Ann_al1_301/v1/render_pt.rs", &solution()),
        (
            "Ex/Sheet/Lee_Ann_al1_301/v2/render_pt.rs",
            &starter().replace("PathTracer {\n    settings", "PathTracer {\n\n    settings"),
        ),
    ]);
    course.write(
        "status.csv",
        "update,usr_id,login,lastname,firstname,status,mark,notice,comment\n0,301,al1,Lee,Ann,notgraded,,,\n",
    );
    course.write("course.yml", "deadline: 2026-05-21 23:59\n");
    let row = |time: &str, version: &str| format!("al1,{time},Ex/Sheet/Lee_Ann_al1_301/{version}\n");
    let arguments =
        ["--ilias=status.csv", "--manifest=m.csv", "--course=course.yml", "--out=out", "--resume"];
    for (second, expected) in [("2026-05-21 23:00", 0.0), ("2026-05-22 03:00", 10.0)] {
        course.write(
            "m.csv",
            &format!("student,received_at,path\n{}{}", row("2026-05-20 10:00", "v1"), row(second, "v2")),
        );
        course.run(&arguments);
        assert_eq!(course.results("out")["al1"].2, Some(expected), "the second came at {second}");
    }
    let status = std::fs::read_to_string(course.path("out/status.csv")).expect("it is there");
    assert!(status.contains("\n1,301,al1,Lee,Ann,notgraded,10,,"), "{status}");
}

#[test]
fn a_packed_submission_is_the_same_each_time_and_is_taken_in_again() {
    let course = Course::new(&[]);
    course.write("mine.rs", &solution());
    course.write("why.txt", "because");
    course.write("course.yml", "deadline: 2020-05-21 23:59\n");
    let pack = |file: &str, out: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_grader"));
        command.args([
            "pack",
            file,
            "--explanation=why.txt",
            "--course=course.yml",
            "--out",
            out,
            "--assignment",
        ]);
        command.arg(course.path("rubric")).current_dir(course.path(".")).output().expect("the program starts")
    };
    let told = pack("mine.rs", "a.zip");
    assert_eq!(told.status.code(), Some(0), "{}", stderr(&told));
    pack("mine.rs", "b.zip");
    let bytes = std::fs::read(course.path("a.zip")).expect("it is there");
    assert_eq!(bytes, std::fs::read(course.path("b.zip")).expect("it is there"));
    let said = String::from_utf8_lossy(&told.stdout).into_owned();
    assert!(said.contains(&intake::md5_of(&bytes)) && said.contains("no longer accepted"), "{said}");
    let [file_name, type_name, starter] = ["render_pt.rs", "PathTracer", ""].map(str::to_owned);
    let wanted = intake::Wanted { file_name, type_name, starter };
    let taken = intake::take(&[course.path("a.zip")], &wanted, None).expect("it is there");
    assert_eq!(taken.outcome.expect("it is taken").source, solution());
    assert_eq!(taken.explanations[0].text.as_deref(), Some("because"));
    course.write("broken.rs", "fn main( {");
    let refused = pack("broken.rs", "c.zip");
    assert_eq!(refused.status.code(), Some(2));
    assert!(!course.path("c.zip").exists());
}
