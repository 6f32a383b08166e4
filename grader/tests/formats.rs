//! Formats of other systems, checked by validators that other projects wrote.
//!
//! `.ci/validators` installs them into `target/validators`; `.ci/run` does that and runs these tests. Each validator also
//! has to refuse something that is wrong, so that one that accepts everything is noticed.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use verdict::sample::{evil_report, report, with_staff_only_checks};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").canonicalize().expect("the checkout is there")
}

/// Runs a validator. Its last argument is the file.
fn validate(program: &str, arguments: &[&str], file: &Path) -> Output {
    let program = root().join("target/validators/bin").join(program);
    let output = Command::new(&program).args(arguments).arg(file).output();
    output.unwrap_or_else(|error| panic!("{}: {error}: run .ci/validators", program.display()))
}

fn assert_valid(program: &str, arguments: &[&str], file: &Path) {
    let output = validate(program, arguments, file);
    let told = [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    assert!(output.status.success(), "{program} {}: {}", file.display(), told.concat());
}

/// Asserts that a validator refuses a file in which `from` is replaced.
fn assert_bites(program: &str, arguments: &[&str], file: &Path, (from, to): (&str, &str)) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let text = std::fs::read_to_string(file).expect("it is there");
    assert!(text.contains(from), "{} has no `{from}`", file.display());
    let wrong = folder.path().join(file.file_name().expect("it has a name"));
    std::fs::write(&wrong, text.replacen(from, to, 1)).expect("it can be written");
    let output = validate(program, arguments, &wrong);
    assert!(!output.status.success(), "{program} accepts {} with `{to}`", file.display());
}

/// Files of templates of all assignments whose names contain a word.
fn templates(word: &str) -> Vec<PathBuf> {
    let assignments = std::fs::read_dir(root().join("assignments")).expect("it can be listed");
    let folders = assignments.flatten().map(|assignment| assignment.path().join("ci"));
    let files = folders.filter_map(|folder| std::fs::read_dir(folder).ok()).flatten().flatten();
    let named = files.map(|file| file.path()).filter(|path| {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        name.contains(word) && name.ends_with(".yml")
    });
    let found: Vec<PathBuf> = named.collect();
    assert!(!found.is_empty(), "there are templates for {word}");
    found
}

#[test]
#[ignore = "needs .ci/validators"]
fn junit_is_what_jenkins_takes() {
    let schema = root().join("target/validators/junit-10.xsd").display().to_string();
    let arguments = ["--schema", schema.as_str()];
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = |name: &str| folder.path().join(name);
    let grader = |arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_grader"));
        let output = command.args(arguments).current_dir(folder.path()).output().expect("it starts");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    };
    let student_file = root().join("skeleton/src/algorithms/render_pt.rs").display().to_string();
    std::fs::write(path("broken.rs"), "pub struct PathTracer;\nfn main( {").expect("it can be written");
    grader(&["grade", &student_file, "--no-report", "--allow-sandbox=none", "--export=junit:graded.xml"]);
    grader(&["grade", "broken.rs", "--no-report", "--allow-sandbox=none", "--export=junit:broken.xml"]);
    for (name, report) in
        [("plain", report("x")), ("evil", evil_report()), ("staff", with_staff_only_checks())]
    {
        report.save(&path(&format!("{name}.json"))).expect("it can be saved");
        let (json, xml) = (format!("{name}.json"), format!("{name}.xml"));
        grader(&["export", &json, "--format=junit", "--out", &xml]);
    }
    for name in ["graded", "broken", "plain", "evil", "staff"] {
        assert_valid("xmlschema-validate", &arguments, &path(&format!("{name}.xml")));
    }
    let wrong = ("<testsuites ", "<testsuites skipped=\"1\" ");
    assert_bites("xmlschema-validate", &arguments, &path("graded.xml"), wrong);
}

#[test]
#[ignore = "needs .ci/validators"]
fn workflows_are_what_github_takes() {
    let schema = ["--builtin-schema", "vendor.github-workflows"];
    for file in templates("github") {
        assert_valid("actionlint", &[], &file);
        assert_valid("check-jsonschema", &schema, &file);
        assert_bites("actionlint", &[], &file, ("runs-on: ubuntu-24.04", "runs-on: ubuntu-99"));
        assert_bites("check-jsonschema", &schema, &file, ("runs-on:", "run-on:"));
    }
}

#[test]
#[ignore = "needs .ci/validators"]
fn pipelines_are_what_gitlab_takes() {
    let arguments = ["--builtin-schema", "vendor.gitlab-ci", "--data-transform", "gitlab-ci"];
    for file in templates("gitlab") {
        assert_valid("check-jsonschema", &arguments, &file);
        assert_bites("check-jsonschema", &arguments, &file, ("when: always", "when: sometimes"));
    }
}

#[test]
#[ignore = "needs .ci/validators"]
fn jobs_are_what_kubernetes_takes() {
    for file in templates("kubernetes") {
        assert_valid("kubernetes-validate", &["--strict"], &file);
        assert_bites("kubernetes-validate", &["--strict"], &file, ("backoffLimit", "backofLimit"));
    }
}
