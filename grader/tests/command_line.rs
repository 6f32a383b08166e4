//! The program as its users call it.

use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command, Output, Stdio};

use verdict::report::{Report, TaskState};

fn grader(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_grader"));
    command.args(arguments).current_dir(folder).output().expect("the program starts")
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// The student file, from anywhere.
fn student_file() -> String {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../skeleton/src/algorithms/render_pt.rs")
        .display()
        .to_string()
}

#[test]
fn a_grade_ends_with_0_whatever_the_points_unless_fewer_than_asked_for() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = student_file();
    let graded = grader(folder.path(), &["grade", &file, "--only=point_plane", "--out=here"]);
    assert_eq!(graded.status.code(), Some(0), "{}", stderr(&graded));
    let report =
        std::fs::read_to_string(folder.path().join("here/report.json")).expect("the report is there");
    let report: serde_json::Value = serde_json::from_str(&report).expect("the report is JSON");
    assert_eq!(report["schema"], "arty-report/2");
    for key in [
        "submission",
        "assignment",
        "points",
        "tasks",
        "checks",
        "skipped",
        "diagnosis",
        "numerics",
        "cost",
        "sandbox",
        "provenance",
    ] {
        assert!(!report[key].is_null(), "{key}");
    }
    assert!(
        report["convergence"].is_null() && !folder.path().join("here/report.html").exists(),
        "--only is short"
    );
    let too_few = grader(folder.path(), &["grade", &file, "--fail-under=1"]);
    assert_eq!(too_few.status.code(), Some(1), "{}", stderr(&too_few));
    // What follows the points is there although they are too few, and of a size that can be sent by mail.
    let page = std::fs::read_to_string(folder.path().join("report/report.html")).expect("the page is there");
    assert!(
        page.contains("<svg class=\"convergence\"") && page.contains("data-plane"),
        "a plot and pictures"
    );
    assert!(page.len() < 3_000_000, "{} bytes", page.len());
}

#[test]
fn what_staff_or_student_typed_wrong_ends_with_2_and_one_clear_message() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = student_file();
    let empty = folder.path().join("empty");
    std::fs::create_dir(&empty).expect("it can be made");
    let empty = empty.display().to_string();
    for (arguments, expected) in [
        (vec!["grade", "nowhere.rs"], "nowhere.rs"),
        (vec!["grade", &empty], "there is no render_pt.rs"),
        (vec!["grade", &file, "--only=nonsense"], "--only: no such check"),
        (vec!["grade", &file, "--assignment=99"], "rubric.yml"),
        (vec!["grade", "--seed=x"], "invalid value"),
        (vec!["grade", &file, "--out", &file], "render_pt.rs"),
        (vec!["grade", &file, "--only=point_plane", "--fail-under=1"], "cannot be used with"),
    ] {
        let output = grader(folder.path(), &arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(expected), "{arguments:?}: {}", stderr(&output));
    }
}

#[test]
fn old_names_of_options_are_refused_with_the_new_ones() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = student_file();
    let arguments = ["replay", &file, "--scene=point_plane", "--pixel=1,1", "--sample=0", "--hits-off"];
    let output = grader(folder.path(), &arguments);
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    assert!(stderr(&output).contains("--emission-on-hit=off"), "{}", stderr(&output));
}

#[test]
fn the_checkout_is_that_of_the_current_folder_or_the_one_that_is_named() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let other = folder.path().join("other");
    for name in ["skeleton", "scenes"] {
        std::fs::create_dir_all(other.join(name)).expect("it can be made");
    }
    std::fs::write(other.join("skeleton/Cargo.toml"), "").expect("it can be written");
    // There is no such scene in it. Standing in it, one has to say which checkout is meant.
    let option = format!("--workspace={}", other.display());
    for (stands_in, named, says) in [
        (other.as_path(), None, option.as_str()),
        (other.as_path(), Some(option.as_str()), "other/scenes"),
        (folder.path(), Some(option.as_str()), "other/scenes"),
    ] {
        let arguments: Vec<&str> = ["plan", "point_plane"].into_iter().chain(named).collect();
        let output = grader(stands_in, &arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(says), "{arguments:?}: {}", stderr(&output));
    }
    let known = grader(folder.path(), &["plan", "point_plane"]);
    assert_eq!(known.status.code(), Some(0), "{}", stderr(&known));
    let nowhere = grader(folder.path(), &["plan", "point_plane", "--workspace=."]);
    assert_eq!(nowhere.status.code(), Some(2), "{}", stderr(&nowhere));
}

#[test]
fn a_checkout_without_the_solution_shows_only_commands_for_students() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let help = |folder: &Path, arguments: &[&str]| {
        String::from_utf8_lossy(&grader(folder, arguments).stdout).into_owned()
    };
    let staff = help(folder.path(), &["--help"]);
    for name in ["skeleton", "scenes"] {
        std::fs::create_dir_all(folder.path().join(name)).expect("it can be made");
    }
    std::fs::write(folder.path().join("skeleton/Cargo.toml"), "").expect("it can be written");
    let student = help(folder.path(), &["--help"]);
    for command in ["class", "mark", "plan", "export", "converge"] {
        assert!(staff.contains(&format!("\n  {command} ")), "{staff}");
        assert!(!student.contains(&format!("\n  {command} ")), "{student}");
    }
    for command in ["grade", "hint", "replay", "pack"] {
        assert!(student.contains(&format!("\n  {command} ")), "{student}");
    }
    assert!(!help(folder.path(), &["grade", "--help"]).contains("--missing-is-zero"));
}

#[test]
fn a_program_that_prints_is_graded_as_fast_and_says_so() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let source = std::fs::read_to_string(student_file()).expect("it is there");
    let given = "for bounce in 0..=self.settings.max_bounces {";
    let noisy = source.replacen(given, &format!("{given} println!(\"{{bounce}}\"); dbg!(bounce, 1.5);"), 1);
    assert_ne!(noisy, source);
    std::fs::write(folder.path().join("render_pt.rs"), noisy).expect("it can be written");
    let graded = grader(folder.path(), &["grade", "render_pt.rs", "--only=5.1"]);
    assert_eq!(graded.status.code(), Some(0), "{}", stderr(&graded));
    let said = String::from_utf8_lossy(&graded.stdout).into_owned();
    assert!(said.contains("your program prints (render_pt.rs:"), "{said}");
    let report = Report::load(&folder.path().join("report/report.json")).expect("there is a report");
    assert!(report.checks.len() > 20, "5.1 is 5.1a and 5.1b: {}", report.checks.len());
    let late = report.checks.iter().filter(|check| check.reason == verdict::check::Reason::Timeout).count();
    assert_eq!(late, 0, "printing costs no time");
    let replay = ["replay", "render_pt.rs", "--scene=cornell_box", "--pixel=1,1", "--sample=0"];
    let replayed = String::from_utf8_lossy(&grader(folder.path(), &replay).stdout).into_owned();
    assert!(replayed.contains("prints") && replayed.contains("bounce = 0"), "{replayed}");

    // The next step, then more about it, level by level.
    let hint =
        |level: &str| String::from_utf8_lossy(&grader(folder.path(), &["hint", level]).stdout).into_owned();
    assert!(hint("1").contains("Next: 5.1a") && hint("1").contains("cargo hint 2"), "{}", hint("1"));
    assert!(hint("2").contains("hint: "), "{}", hint("2"));
    let last = hint("3");
    assert!(
        last.contains("render_pt.rs:") && last.contains("sheet.md") && last.contains("rerun: "),
        "{last}"
    );
    assert!(!last.contains("cargo hint"), "{last}");
}

#[test]
fn what_is_there_and_cannot_be_graded_has_no_points_and_a_code() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("render_pt.rs");
    for (bytes, code) in [
        (b"// x\n".repeat(200_000), "too-large"),
        (b"PK\x03\x04 a Word document".to_vec(), "not-source"),
        (Vec::new(), "empty"),
    ] {
        std::fs::write(&file, bytes).expect("it can be written");
        let graded = grader(folder.path(), &["grade", "render_pt.rs", "--fail-under=1", "--out=here"]);
        assert_eq!(graded.status.code(), Some(1), "{code}: {}", stderr(&graded));
        let report = std::fs::read(folder.path().join("here/report.json")).expect("the report is there");
        let report: serde_json::Value = serde_json::from_slice(&report).expect("the report is JSON");
        assert_eq!(report["submission"]["refusal"]["code"], code);
        assert_eq!(report["points"]["earned"], 0.0);
        assert!(folder.path().join("here/report.html").is_file(), "{code}");
    }
}

#[test]
fn a_grade_says_what_was_odd_and_what_being_late_costs() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let solution = Path::new(env!("CARGO_MANIFEST_DIR")).join("../solution/src/algorithms/render_pt.rs");
    let solution = std::fs::read_to_string(solution).expect("the solution is there");
    let with_mark = format!("\u{feff}{}", solution.replace('\n', "\r\n"));
    std::fs::write(folder.path().join("mine.rs"), with_mark).expect("it can be written");
    std::fs::write(folder.path().join("course.yml"), "deadline: 2026-05-21 23:59\n")
        .expect("it can be written");
    let arguments = [
        "grade",
        "mine.rs",
        "--no-report",
        "--assignment=../grader/hostile",
        "--course=course.yml",
        "--received-at=2026-05-22 01:00",
    ];
    let graded = grader(folder.path(), &arguments);
    assert_eq!(graded.status.code(), Some(0), "{}", stderr(&graded));
    assert!(stderr(&graded).contains("note: line ends of another system"), "{}", stderr(&graded));
    let said = String::from_utf8_lossy(&graded.stdout).into_owned();
    assert!(said.contains("× 0.8; 24 of 30 points count"), "{said}");
}

/// Runs the grader in bash, where `"$0"` is the program and `"$1"` the student file.
#[cfg(unix)]
fn in_bash(folder: &Path, script: &str) -> Output {
    let mut bash = Command::new("bash");
    bash.args(["-o", "pipefail", "-c", script, env!("CARGO_BIN_EXE_grader"), &student_file()]);
    bash.current_dir(folder).output().expect("bash starts")
}

#[test]
#[cfg(unix)]
fn a_closed_pipe_ends_nothing_but_the_output() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    // Both streams are closed before the program writes to them.
    for command in [
        "grade \"$1\" --only=point_plane",
        "plan point_plane",
        "doctor",
        "--help",
        "completions bash",
        "replay --help",
    ] {
        let output = in_bash(folder.path(), &format!("{{ sleep 0.2; \"$0\" {command} 2>&3; }} 3>&1 | true"));
        assert_eq!(output.status.code(), Some(0), "{command}: {}", stderr(&output));
        let output = in_bash(folder.path(), &format!("{{ sleep 0.2; \"$0\" {command}; }} | true"));
        assert_eq!(output.status.code(), Some(0), "{command}: {}", stderr(&output));
        assert!(!stderr(&output).contains("panicked"), "{command}: {}", stderr(&output));
    }
    assert!(folder.path().join("report/report.json").is_file());
}

#[test]
#[cfg(target_os = "linux")]
fn what_cannot_be_written_ends_with_3_and_is_named() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (command, name) in [
        ("plan point_plane >/dev/full", "standard output"),
        ("grade \"$1\" --only=point_plane --out=/proc/report", "/proc/report"),
        ("grade \"$1\" --only=point_plane --export=junit:/proc/junit.xml", "/proc/junit.xml"),
        ("pack \"$1\" --out=/proc/submission.zip", "/proc/submission.zip"),
        (
            "replay \"$1\" --scene=point_plane --pixel=1,1 --sample=0 --json=/proc/path.json",
            "/proc/path.json",
        ),
    ] {
        let output = in_bash(folder.path(), &format!("\"$0\" {command}"));
        assert_eq!(output.status.code(), Some(3), "{command}: {}", stderr(&output));
        assert!(stderr(&output).contains(name), "{command}: {}", stderr(&output));
    }
}

#[test]
fn points_are_printed_before_they_can_be_lost() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut child = Command::new(env!("CARGO_BIN_EXE_grader"))
        .args(["grade", &student_file(), "--only=light-pick", "--out=out"])
        .current_dir(folder.path())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let mut lines = BufReader::new(child.stderr.take().expect("it is piped")).lines().map_while(Result::ok);
    // Printed once it is known that the folder can be written to, and before anything is compiled.
    assert!(lines.any(|line| line.contains("unchanged starting file")), "it ended early");
    std::fs::remove_dir_all(folder.path().join("out")).expect("it can be removed");
    let rest: Vec<String> = lines.collect();
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(output.status.code(), Some(3), "{rest:?}");
    assert!(rest.iter().any(|line| line.contains("out/report.json")), "{rest:?}");
    let printed = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(printed.contains("graded automatically"), "{printed}");
}

#[test]
#[cfg(unix)]
fn a_machine_without_a_linker_is_not_the_submission_s_fault() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    // Only cargo and rustc are found.
    let tools = folder.path().join("tools");
    std::fs::create_dir(&tools).expect("it can be made");
    for (tool, variable) in [("cargo", "CARGO"), ("rustc", "RUSTC")] {
        let found = std::env::var(variable).unwrap_or_else(|_| which(tool));
        std::os::unix::fs::symlink(found, tools.join(tool)).expect("it can be linked");
    }
    let warm = grader(folder.path(), &["grade", &student_file(), "--only=point_plane"]);
    assert_eq!(warm.status.code(), Some(0), "the framework is built: {}", stderr(&warm));
    let output = Command::new(env!("CARGO_BIN_EXE_grader"))
        .args(["grade", &student_file(), "--only=point_plane"])
        .current_dir(folder.path())
        .env("PATH", &tools)
        .output()
        .expect("the program starts");
    assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
    assert!(stderr(&output).contains("not even an empty submission compiles"), "{}", stderr(&output));
}

/// The first program of that name in the search path.
#[cfg(unix)]
fn which(tool: &str) -> String {
    let path = std::env::var_os("PATH").expect("there is a search path");
    let found = std::env::split_paths(&path).map(|folder| folder.join(tool)).find(|file| file.is_file());
    found.expect("the tool is installed").display().to_string()
}

#[test]
fn a_person_marks_what_is_not_graded_automatically_and_nothing_else() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::copy(student_file(), folder.path().join("render_pt.rs")).expect("it can be copied");
    std::fs::write(folder.path().join("why.md"), "Each technique is noisy elsewhere.")
        .expect("it can be written");
    let graded = grader(folder.path(), &["grade", ".", "--only=light-pick", "--out=here"]);
    let text = String::from_utf8_lossy(&graded.stdout).into_owned();
    assert!(text.contains("why.md, 5 words"), "{text}{}", stderr(&graded));

    for (task, points, expected) in
        [("5.1a", "3", "graded automatically"), ("5.2a", "11", "0 to 10 points"), ("6", "1", "no task `6`")]
    {
        let refused = grader(folder.path(), &["mark", ".", task, points, "--out=here"]);
        assert_eq!(refused.status.code(), Some(2));
        assert!(stderr(&refused).contains(expected), "{}", stderr(&refused));
    }
    let marked = grader(folder.path(), &["mark", ".", "5.2a", "8", "--comment=well seen", "--out=here"]);
    assert_eq!(marked.status.code(), Some(0), "{}", stderr(&marked));
    // Grading again loses nothing of it.
    for again in [false, true] {
        if again {
            grader(folder.path(), &["grade", ".", "--only=light-pick", "--out=here"]);
        }
        let report = Report::load(&folder.path().join("here/report.json")).expect("it is there");
        let task = report.tasks.iter().find(|task| task.id == "5.2a").expect("it is a task");
        assert_eq!(task.points, Some(8.0), "again: {again}");
        assert_eq!(task.state, TaskState::ByHand { comment: Some("well seen".to_owned()) }, "again: {again}");
        assert_eq!(report.points.manual, Some(8.0));
        assert_eq!(report.submission.explanations.len(), 1);
    }
}
