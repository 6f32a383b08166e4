//! The program as its users call it.

use std::path::Path;
use std::process::{Command, Output};

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
    assert!(said.contains("× 0.8; 8 of 10 points count"), "{said}");
}

#[test]
#[cfg(unix)]
fn a_closed_pipe_costs_nobody_the_report() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let script =
        format!("'{}' grade '{}' --only=point_plane | true", env!("CARGO_BIN_EXE_grader"), student_file());
    let mut shell = Command::new("bash");
    let status = shell.args(["-o", "pipefail", "-c", &script]).current_dir(folder.path()).status();
    assert_eq!(status.expect("bash starts").code(), Some(0));
    assert!(folder.path().join("report/report.json").is_file());
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
