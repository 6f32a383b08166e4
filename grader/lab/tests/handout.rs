//! The handout as students get it: it builds and grades by itself, and contains nothing of the solution.
//!
//! Its folder stays in `target/tmp` with its build: the first run takes minutes, later ones less than two.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use harness::assignment::Assignment;
use harness::workspace::Workspace;
use lab::handout::secrets;
use verdict::check::{CheckKind, Verdict, WhyNot};
use verdict::report::Report;

fn workspace() -> Workspace {
    Workspace::find().expect("the tests run inside the checkout")
}

fn assignment() -> Assignment {
    Assignment::open(&workspace(), "05-nee-mis").expect("it is sound")
}

fn solution() -> String {
    assignment().solution().expect("the solution is there")
}

fn lab(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_lab")).args(arguments).output().expect("the program starts")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Makes the handout at `folder`; an earlier build there stays.
fn make(folder: &Path) {
    let built = folder.with_extension("built");
    if folder.exists() {
        // A test that was interrupted may have left something.
        let _ = std::fs::remove_dir_all(&built);
        let _ = std::fs::rename(folder.join("target"), &built);
        std::fs::remove_dir_all(folder).expect("the earlier handout can be removed");
    }
    let made = lab(&["handout", "--out", &folder.display().to_string()]);
    assert_eq!(made.status.code(), Some(0), "{}", text(&made.stderr));
    if built.is_dir() {
        std::fs::rename(&built, folder.join("target")).expect("it can be moved back");
    }
}

fn files_below(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("it can be listed") {
        let path = entry.expect("it can be read").path();
        if path.is_dir() {
            files_below(&path, found);
        } else {
            found.push(path);
        }
    }
}

/// Calls Cargo as a student would, without the environment of this test.
fn cargo(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.args(arguments).current_dir(folder);
    for (name, _) in std::env::vars_os() {
        let name = name.to_string_lossy().into_owned();
        let ours = name.starts_with("CARGO_") && name != "CARGO_HOME" && !name.starts_with("CARGO_NET");
        if ours || name.starts_with("GITHUB_") {
            command.env_remove(name);
        }
    }
    command.output().expect("cargo starts")
}

fn report(folder: &Path) -> Report {
    Report::load(&folder.join("report/report.json")).expect("there is a report")
}

#[test]
fn a_handout_holds_nothing_of_the_solution() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("handout");
    make(&out);
    let secrets = secrets(&assignment()).expect("the solution differs");
    assert!(secrets.find(&solution()).is_some(), "the search finds what it is for");
    let mut files = Vec::new();
    files_below(&out, &mut files);
    assert!(files.len() > 400, "{} files", files.len());
    for file in &files {
        let bytes = std::fs::read(file).expect("it can be read");
        assert_eq!(secrets.find(&text(&bytes)), None, "{}", file.display());
        let name = file.strip_prefix(&out).expect("it is below").display().to_string();
        for kept in ["solution", ".git/", "hostile", "variants/", "kill-matrix", "calibration.md", "hidden/"]
        {
            let of_a_check = name.starts_with("grader/judge/src/checks/hidden_variants/");
            assert!(!name.contains(kept) || of_a_check, "{name}");
        }
    }
    for there in
        ["README.md", ".github/workflows/grade.yml", ".vscode/tasks.json", "assignments/05-nee-mis/sheet.md"]
    {
        assert!(out.join(there).is_file(), "{there}");
    }
}

#[test]
fn a_starting_file_with_the_solution_in_it_is_not_handed_out() {
    let secrets = secrets(&assignment()).expect("the solution differs");
    let starter = std::fs::read_to_string(assignment().student_file()).expect("it is there");
    assert_eq!(secrets.find(&starter), None);
    let block = "let p_ne = p_light(scene) * sample.pdf_area * distance * distance / sample.cos_light;";
    let spoilt = starter.replacen("// END 5.1a", &format!("{block}\n// END 5.1a"), 1);
    assert_ne!(spoilt, starter);
    assert!(secrets.find(&spoilt).is_some(), "one line is enough");
}

#[test]
fn a_handout_is_written_to_a_new_folder_only() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().display().to_string();
    std::fs::write(folder.path().join("mine"), "x").expect("it can be written");
    let refused = lab(&["handout", "--out", &out]);
    assert_eq!(refused.status.code(), Some(2), "{}", text(&refused.stderr));
    assert_eq!(std::fs::read_dir(folder.path()).expect("it is there").count(), 1, "nothing else was written");
}

/// The first run builds grader and framework in release mode, which takes minutes.
#[test]
fn a_handout_builds_and_grades_by_itself() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("handout");
    make(&folder);

    let starter = cargo(&folder, &["grade", "--no-report"]);
    assert_eq!(starter.status.code(), Some(0), "{}", text(&starter.stderr));
    let graded = report(&folder);
    assert_eq!(graded.points.earned, 0.0, "{:#?}", graded.tasks);

    let file = assignment().solution_file().display().to_string();
    let right = cargo(&folder, &["grade", &file, "--no-report"]);
    assert_eq!(right.status.code(), Some(0), "{}", text(&right.stderr));
    let graded = report(&folder);
    let failed: Vec<_> = graded.checks.iter().filter(|check| check.verdict != Verdict::Pass).collect();
    assert!(failed.is_empty(), "{failed:#?}");
    // All points but those of checks that only staff can run, which are few.
    let points = graded.points;
    assert_eq!(points.earned + points.staff_only, points.automatic_max, "{points:?}");
    assert!(points.staff_only > 0.0 && points.staff_only < 0.1 * points.automatic_max, "{points:?}");
    let why: Vec<&WhyNot> = graded
        .skipped
        .iter()
        .filter(|skipped| skipped.kind == CheckKind::HiddenVariants)
        .map(|skipped| &skipped.why)
        .collect();
    assert_eq!(why, [&WhyNot::NoSolution; 2]);
    // How it is said is up to `present`.
    assert!(text(&right.stdout).contains(&points.staff_only.to_string()), "{}", text(&right.stdout));

    // A scene of the rubric that only staff have.
    let rubric = folder.join("assignments/05-nee-mis/rubric.yml");
    let known = std::fs::read_to_string(&rubric).expect("it is there");
    let first = "- { check: mean-bias, scene: three_points,";
    let cellar = "- { check: mean-bias, scene: hidden/cellar, technique: nee, max_bounces: 1 }";
    let hidden = known.replacen(first, &format!("{cellar}\n      {first}"), 1);
    assert_ne!(hidden, known);
    std::fs::write(&rubric, hidden).expect("it can be written");
    let right = cargo(&folder, &["grade", &file, "--no-report"]);
    assert_eq!(right.status.code(), Some(0), "{}", text(&right.stderr));
    let graded = report(&folder);
    let cellar = graded.skipped.iter().find(|skipped| skipped.scene == "hidden/cellar");
    assert_eq!(cellar.map(|skipped| &skipped.why), Some(&WhyNot::SceneNotHere));
    assert!(graded.points.staff_only > points.staff_only, "{:?}", graded.points);
    assert_eq!(graded.points.earned + graded.points.staff_only, points.automatic_max, "{:?}", graded.points);

    // No test of the grader is included.
    let tests = cargo(&folder, &["test", "-p", "grader", "-p", "host"]);
    assert_eq!(tests.status.code(), Some(0), "{}", text(&tests.stderr));
    assert!(!text(&tests.stdout).contains("running"), "{}", text(&tests.stdout));
}
