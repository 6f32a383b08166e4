//! Assignments are folders: no program knows one of them, and each is what its folder says.

use std::path::{Path, PathBuf};

use harness::assignment::Assignment;
use harness::sandbox::Limits;
use harness::workspace::Workspace;
use judge::grade::{Grader, Options};
use lab::handout::secrets;
use lab::mutants::{Kind, variants};
use lab::new_assignment::create;
use verdict::check::Verdict;
use verdict::report::{Cause, Report};
use verdict::submission::Submission;

fn workspace() -> Workspace {
    Workspace::find().expect("the tests run inside the checkout")
}

fn all() -> Vec<Assignment> {
    let workspace = workspace();
    let names = workspace.assignments().expect("they can be listed");
    names.iter().map(|name| Assignment::open(&workspace, name).expect("its rubric is sound")).collect()
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

/// Words that belong to one assignment: its name, its student file, its tasks.
fn words_of_assignments() -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    for assignment in all() {
        words.push(assignment.rubric.assignment.clone());
        words.push(assignment.rubric.submission.name().to_owned());
        words.push(assignment.rubric.submission.path.clone());
        // A number alone may be any number.
        let ids = assignment.rubric.tasks.iter().map(|task| task.id.clone());
        words.extend(ids.filter(|id| id.parse::<f64>().is_err()));
    }
    words.sort();
    words.dedup();
    words
}

/// The words that a source names outside of its tests.
fn named(text: &str, words: &[String]) -> Vec<String> {
    let code = text.split("#[cfg(test)]").next().unwrap_or_default();
    let is_apart = |text: &str, at: usize, length: usize| {
        let is_part = |letter: char| letter.is_alphanumeric() || letter == '.' || letter == '_';
        let before = text[..at].chars().next_back();
        let after: String = text[at + length..].chars().take(2).collect();
        let goes_on = after.starts_with(|next: char| next.is_alphanumeric() || next == '_')
            || (after.starts_with('.') && after.chars().nth(1).is_some_and(|next| next.is_ascii_digit()));
        !before.is_some_and(is_part) && !goes_on
    };
    let has =
        |word: &&String| code.match_indices(word.as_str()).any(|(at, found)| is_apart(code, at, found.len()));
    words.iter().filter(has).cloned().collect()
}

#[test]
fn no_program_of_the_grader_knows_an_assignment() {
    let words = words_of_assignments();
    let root = workspace().root().join("grader");
    let mut files = Vec::new();
    files_below(&root, &mut files);
    let is_source = |path: &PathBuf| {
        let extension = path.extension().and_then(|it| it.to_str()).unwrap_or_default();
        let inner = path.strip_prefix(&root).expect("it is below").to_string_lossy().replace('\\', "/");
        // Tests, attacks and what they are held to are about this course.
        let is_test =
            inner.split('/').any(|part| matches!(part, "tests" | "hostile" | "fuzz" | "target" | "benches"))
                || inner.ends_with("/tests.rs")
                || inner.ends_with("verdict/src/sample.rs");
        ["rs", "sh", "yml", "css", "js", "html"].contains(&extension) && !is_test
    };
    let sources: Vec<PathBuf> = files.into_iter().filter(is_source).collect();
    assert!(sources.len() > 300, "{}", sources.len());
    for path in sources {
        let text = std::fs::read_to_string(&path).expect("it can be read");
        let named = named(&text, &words);
        assert!(named.is_empty(), "{} names {named:?}, which belongs to one assignment", path.display());
    }
}

#[test]
fn words_of_assignments_are_found_in_code_and_not_in_tests() {
    let words = ["5.1a", "render_pt.rs"].map(str::to_owned);
    for (text, expected) in [
        ("let x = \"render_pt.rs\";", 1),
        ("in task 5.1a, and render_pt.rs:7", 2),
        ("15.1a 5.1ab 5.1a.2 my_render_pt.rs", 0),
        ("fn f() {}\n#[cfg(test)]\nmod tests { \"5.1a\" }", 0),
    ] {
        assert_eq!(named(text, &words).len(), expected, "{text}");
    }
}

#[test]
fn each_folder_is_named_as_its_rubric_says_and_has_what_a_course_needs() {
    for assignment in all() {
        assert_eq!(assignment.name, assignment.rubric.assignment);
        let folder = &assignment.folder;
        for file in [folder.sheet(), folder.starter_file(), folder.causes_file(), assignment.solution_file()]
        {
            assert!(file.is_file(), "{}", file.display());
        }
        let sheet = std::fs::read_to_string(folder.sheet()).expect("it can be read");
        for task in &assignment.rubric.tasks {
            // A lettered part is a section below its number.
            let number = task.id.trim_end_matches(|letter: char| letter.is_ascii_lowercase());
            assert!(
                sheet.contains(&format!("## {number} ")),
                "{}: the sheet has no section {number}",
                assignment.name
            );
        }
        secrets(&assignment).expect("the solution differs from the starting file");
    }
}

#[test]
fn every_variant_fits_its_solution_and_every_mistake_has_a_cause() {
    for assignment in all() {
        let all =
            variants(&assignment).expect("each replacement fits the solution, each task the rubric").list;
        let catalogue = judge::diagnosis::Catalogue::load(&assignment.folder, &assignment.rubric)
            .expect("causes are sound");
        for variant in all.iter().filter(|variant| variant.kind == Kind::Wrong) {
            assert!(catalogue.cause_of(&variant.id).is_some(), "{}: {}", assignment.name, variant.id);
        }
        assert!(all.iter().any(|variant| variant.kind == Kind::Right), "{}", assignment.name);
    }
}

/// The sheet before hands out what its solution has to become, and the sheet after begins with it.
#[test]
fn the_path_tracers_solution_is_the_starting_file_of_the_next_sheet() {
    let [before, after] = ["04-path-tracer", "05-nee-mis"].map(|name| workspace().assignment(name));
    let solution = std::fs::read(before.path().join("solution.rs")).expect("it is there");
    let starter = std::fs::read(after.starter_file()).expect("it is there");
    assert!(
        solution == starter,
        "they differ: cp {0}/starter.rs {1}/solution.rs",
        "assignments/05-nee-mis",
        "assignments/04-path-tracer"
    );
}

/// Grades files with an assignment, named as on the command line.
fn graded(assignment: &str, files: &[PathBuf]) -> Vec<Report> {
    let (workspace, assignment) = (workspace(), assignment.to_owned());
    let options = Options { assignment, seed: 1, threads: 2, only: Vec::new(), limits: Limits::default() };
    let grader = Grader::new(&workspace, &options).expect("the harness works");
    let grade = |file: &PathBuf| {
        let submission = Submission::load_trusted(file).expect("it is there");
        grader.grade(&submission, |_| {}).expect("the harness works")
    };
    files.iter().map(grade).collect()
}

/// The starting file earns nothing and is recognised, the solution earns everything.
fn assert_earns_nothing_at_first_and_everything_at_last(name: &str) {
    let assignment = Assignment::open(&workspace(), name).expect("its rubric is sound");
    let reports = graded(name, &[assignment.folder.starter_file(), assignment.solution_file()]);
    let [starter, solution] = &reports[..] else { panic!("two reports") };
    assert_eq!(starter.submission.build_failure, None);
    assert_eq!(starter.points.earned, 0.0, "{:#?}", starter.tasks);
    assert!(matches!(starter.diagnosis[0].cause, Cause::NotBegun { .. }), "{:?}", starter.diagnosis);
    let failed: Vec<_> = solution.checks.iter().filter(|check| check.verdict != Verdict::Pass).collect();
    assert!(failed.is_empty(), "{failed:#?}");
    assert_eq!(solution.points.earned, solution.points.automatic_max);
}

/// 05's are graded by tests of the judge.
#[test]
fn the_path_tracers_starting_file_earns_nothing_and_its_solution_everything() {
    assert_earns_nothing_at_first_and_everything_at_last("04-path-tracer");
}

#[test]
fn the_environments_starting_file_earns_nothing_and_its_solution_everything() {
    assert_earns_nothing_at_first_and_everything_at_last("06-environment");
}

#[test]
fn a_rubric_that_asks_for_a_mean_that_cannot_be_judged_is_refused() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let rubric =
        std::fs::read_to_string(workspace().assignment("04-path-tracer").rubric_file()).expect("it is there");
    let (known, small) = (
        "mean-bias, scene: glossy_plane, technique: bsdf, max_bounces: 0",
        "mean-bias, scene: cornell_box, technique: bsdf, max_bounces: 1",
    );
    std::fs::write(folder.path().join("rubric.yml"), rubric.replace(known, small))
        .expect("it can be written");
    let assignment = folder.path().display().to_string();
    let only = vec!["cornell_box".to_owned()];
    let options = Options { assignment, seed: 1, threads: 1, only, limits: Limits::default() };
    let message = Grader::new(&workspace(), &options).err().expect("it is refused").to_string();
    assert!(message.contains("cornell_box") && message.contains("% of the bounces"), "{message}");
}

/// A folder in which assignments can be made.
fn empty_checkout() -> (tempfile::TempDir, Workspace) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for name in ["skeleton", "scenes", "assignments"] {
        std::fs::create_dir_all(folder.path().join(name)).expect("it can be made");
    }
    std::fs::write(folder.path().join("skeleton/Cargo.toml"), "").expect("it can be written");
    let workspace = Workspace::open(folder.path()).expect("it has skeleton/ and scenes/");
    (folder, workspace)
}

#[test]
fn a_new_assignment_grades_at_once() {
    let (_folder, checkout) = empty_checkout();
    let file = all().remove(0).rubric.submission;
    let made = create(&checkout, "07-volumes", "Volumes", &file).expect("it can be written");
    let assignment = Assignment::open(&checkout, "07-volumes").expect("its rubric is sound");
    let wrong = made.join("wrong.rs");
    let mistake = variants(&assignment).expect("they fit the solution").list.remove(0);
    std::fs::write(&wrong, mistake.source).expect("it can be written");
    let files = [assignment.folder.starter_file(), assignment.solution_file(), wrong];
    let points: Vec<f64> =
        graded(&made.display().to_string(), &files).iter().map(|report| report.points.earned).collect();
    assert_eq!(points, [0.0, 10.0, 0.0]);
}

#[test]
fn a_new_assignment_is_sound_and_is_never_written_over_another() {
    let (_folder, workspace) = empty_checkout();
    let file = all().remove(0).rubric.submission;
    create(&workspace, "07-volumes", "Volumes", &file).expect("it can be written");
    let made = Assignment::open(&workspace, "07-volumes").expect("its rubric is sound");
    judge::plan::validate(&made.rubric).expect("its checks are valid");
    assert_eq!(variants(&made).expect("they fit the solution").list.len(), 2);
    secrets(&made).expect("the solution differs from the starting file");
    for (name, title) in
        [("07-volumes", "again"), ("", "x"), ("../x", "x"), ("X", "x"), ("08", "a: b"), ("08", "a\nb")]
    {
        create(&workspace, name, title, &file).expect_err(name);
    }
    let left: Vec<_> = std::fs::read_dir(workspace.assignments_folder()).expect("it is there").collect();
    assert_eq!(left.len(), 1, "nothing is left behind");
}
