//! Reports in other systems' formats, and the scripts of these systems, run as they run them.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_yaml::Value;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").canonicalize().expect("the checkout is there")
}

fn grader(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_grader"));
    command
        .args(arguments)
        .current_dir(folder)
        .env_remove("GITHUB_ACTIONS")
        .env_remove("GITHUB_STEP_SUMMARY");
    command.output().expect("the program starts")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn student_file() -> String {
    root().join("skeleton/src/algorithms/render_pt.rs").display().to_string()
}

/// A part of a YAML file.
fn at<'a>(value: &'a Value, path: &[&str]) -> &'a Value {
    path.iter().fold(value, |value, key| &value[*key])
}

/// Runs a script of a CI system in a folder, where `cargo grade` is the grader under test.
fn run_script(folder: &Path, script: &str, environment: &[(&str, String)]) -> Output {
    let tools = folder.join("tools");
    std::fs::create_dir_all(&tools).expect("it can be made");
    let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
    let shim = format!(
        "#!/bin/sh\ncase $1 in\n  grade) exec '{}' \"$@\" ;;\n  grader) shift; exec '{0}' \"$@\" ;;\n  *) exec '{cargo}' \"$@\" ;;\nesac\n",
        env!("CARGO_BIN_EXE_grader")
    );
    std::fs::write(tools.join("cargo"), shim).expect("it can be written");
    let made = Command::new("chmod").arg("+x").arg(tools.join("cargo")).status().expect("chmod is there");
    assert!(made.success());
    let path = std::env::var("PATH").expect("there is a search path");
    let mut shell = Command::new("bash");
    shell
        .args(["--noprofile", "--norc", "-e", "-o", "pipefail", "-c", script])
        .current_dir(folder)
        .env("PATH", format!("{}:{path}", tools.display()))
        .env("CARGO", cargo)
        .env_remove("GITHUB_ACTIONS")
        .env_remove("GITHUB_STEP_SUMMARY")
        .envs(environment.iter().map(|(name, value)| (name, value.as_str())));
    shell.output().expect("bash starts")
}

#[test]
#[cfg(unix)]
fn the_script_for_github_writes_summary_annotations_and_what_is_kept() {
    let file = root().join("assignments/05-nee-mis/ci/github.yml");
    let workflow: Value = serde_yaml::from_str(&read(&file)).expect("it is YAML");
    let steps = at(&workflow, &["jobs", "grade", "steps"]).as_sequence().expect("there are steps");
    let script = run_by(steps, "Grade");
    let folder = tempfile::tempdir().expect("a temporary folder");
    let summary = folder.path().join("summary.md");
    std::fs::write(&summary, "earlier\n").expect("it can be written");
    let environment = [
        ("GITHUB_ACTIONS", "true".to_owned()),
        ("GITHUB_STEP_SUMMARY", summary.display().to_string()),
        ("GITHUB_WORKSPACE", root().display().to_string()),
    ];
    let output = run_script(folder.path(), script, &environment);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let summary = read(&summary);
    assert!(summary.starts_with("earlier\n## 05-nee-mis: 0 of 70 points"), "{summary}");
    let stdout = text(&output.stdout);
    let errors: Vec<&str> = stdout.lines().filter(|line| line.starts_with("::error ")).collect();
    assert!((1..=10).contains(&errors.len()), "{stdout}");
    let mark = read(Path::new(&student_file())).lines().position(|line| line.contains("// TASK 5.1a"));
    let line = mark.expect("the task has a mark") + 1;
    let place = format!("::error file=skeleton/src/algorithms/render_pt.rs,line={line},title=5.1a fail%3A ");
    assert!(errors[0].starts_with(&place), "{}", errors[0]);
    // What the steps after it take.
    let kept =
        steps.iter().find_map(|step| at(step, &["with", "path"]).as_str().filter(|path| *path == "report/"));
    assert!(kept.is_some());
    for name in ["report.json", "report.html", "junit.xml"] {
        assert!(folder.path().join("report").join(name).is_file(), "{name}");
    }
}

#[test]
#[cfg(unix)]
fn the_script_for_gitlab_leaves_the_report_where_gitlab_takes_it() {
    let file = root().join("assignments/05-nee-mis/ci/gitlab.yml");
    let pipeline: Value = serde_yaml::from_str(&read(&file)).expect("it is YAML");
    let job = &pipeline["grade"];
    let script: Vec<&str> =
        job["script"].as_sequence().expect("a list").iter().filter_map(Value::as_str).collect();
    let folder = tempfile::tempdir().expect("a temporary folder");
    let output = run_script(folder.path(), &script.join("\n"), &[]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(!text(&output.stdout).contains("::error"), "that is GitHub's");
    let junit = at(job, &["artifacts", "reports", "junit"]).as_str().expect("a file is named");
    let xml = read(&folder.path().join(junit));
    let report = quick_junit::Report::deserialize_from_str(&xml).expect("it is JUnit's XML");
    assert!(report.failures > 10, "{xml}");
    // GitLab drops all but one of those that have the same name.
    let mut names: Vec<_> = report
        .test_suites
        .iter()
        .flat_map(|suite| suite.test_cases.iter().map(|case| (&suite.name, &case.classname, &case.name)))
        .map(|name| format!("{name:?}"))
        .collect();
    let all = names.len();
    names.sort();
    names.dedup();
    assert_eq!((names.len(), report.tests), (all, all));
}

#[test]
#[cfg(unix)]
fn what_was_built_of_the_same_sources_is_not_built_again() {
    let ci = root().join("assignments/05-nee-mis/ci");
    let github: Value = serde_yaml::from_str(&read(&ci.join("github.yml"))).expect("it is YAML");
    let gitlab: Value = serde_yaml::from_str(&read(&ci.join("gitlab.yml"))).expect("it is YAML");
    let steps = at(&github, &["jobs", "grade", "steps"]).as_sequence().expect("there are steps");
    let scripts = [
        run_by(steps, "Keep what was built"),
        at(&gitlab, &["grade", "before_script"])[0].as_str().expect("a script"),
    ];
    for script in scripts {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let file = |name: &str| folder.path().join(name);
        for name in [
            "Cargo.toml",
            "Cargo.lock",
            ".cargo/config.toml",
            "grader/a.rs",
            "skeleton/b.css",
            "skeleton/render_pt.rs",
        ] {
            std::fs::create_dir_all(file(name).parent().expect("it has one")).expect("it can be made");
            std::fs::write(file(name), name).expect("it can be written");
        }
        let is_old = || -> Vec<bool> {
            let output = run_script(folder.path(), script, &[]);
            assert!(output.status.success() && output.stdout.is_empty(), "{}", text(&output.stderr));
            let old = |name: &str| {
                let age = file(name)
                    .metadata()
                    .and_then(|file| file.modified())
                    .expect("there are times")
                    .elapsed();
                age.expect("it lies in the past").as_secs() > 24 * 3600
            };
            ["Cargo.lock", "skeleton/b.css", "skeleton/render_pt.rs"].map(old).to_vec()
        };
        assert_eq!(is_old(), [false; 3], "nothing was built yet");
        std::fs::write(file("skeleton/render_pt.rs"), "another").expect("it can be written");
        assert_eq!(is_old(), [true, true, false], "all but the submission is the same");
        std::fs::write(file("skeleton/b.css"), "another").expect("it can be written");
        std::fs::write(file("Cargo.lock"), "Cargo.lock").expect("it can be written");
        assert_eq!(is_old(), [false; 3], "it was built of others");
    }
}

/// The script of a step.
#[cfg(unix)]
fn run_by<'a>(steps: &'a [Value], name: &str) -> &'a str {
    let step = steps.iter().find(|step| step["name"] == name).expect("there is such a step");
    step["run"].as_str().expect("it runs a script")
}

/// Autolab takes what goes to either stream as one text, and reads its last line.
#[cfg(unix)]
#[test]
fn what_is_exported_to_standard_output_comes_after_everything_else() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut bash = Command::new("bash");
    bash.args([
        "-c",
        "exec 2>&1; exec \"$0\" \"$@\"",
        env!("CARGO_BIN_EXE_grader"),
        "grade",
        &student_file(),
    ])
    .args(["--only=closed-form/point_plane/mis/1", "--export=autolab"])
    .current_dir(folder.path());
    let output = text(&bash.output().expect("bash starts").stdout);
    assert!(output.contains("report: report/report.json"), "{output}");
    assert!(output.lines().last().is_some_and(|line| line.starts_with("{\"scores\":")), "{output}");
}

#[test]
fn formats_go_where_they_are_asked_for_and_wrong_ones_end_with_2() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = student_file();
    let only = "--only=closed-form/point_plane/mis/1";
    let graded = grader(
        folder.path(),
        &["grade", &file, only, "--quiet", "--export=markdown", "--export=junit:x.xml", "--export=autolab"],
    );
    assert_eq!(graded.status.code(), Some(0), "{}", text(&graded.stderr));
    assert!(read(&folder.path().join("report/summary.md")).starts_with("## 05-nee-mis"));
    assert!(read(&folder.path().join("x.xml")).starts_with("<?xml"));
    let stdout = text(&graded.stdout);
    assert_eq!(stdout.lines().count(), 2, "quiet: the sum and what was asked for: {stdout}");
    assert!(stdout.lines().last().is_some_and(|line| line.starts_with("{\"scores\":")), "{stdout}");

    for format in ["markdown", "junit", "github", "gradescope", "classroom50", "autolab"] {
        let exported = grader(folder.path(), &["export", "report/report.json", "--format", format]);
        assert_eq!(exported.status.code(), Some(0), "{format}: {}", text(&exported.stderr));
        assert!(!exported.stdout.is_empty(), "{format}");
    }
    let broken = folder.path().join("broken.json");
    std::fs::write(&broken, "{}").expect("it can be written");
    let broken = broken.display().to_string();
    for arguments in [
        vec!["grade", &file, only, "--export=word"],
        vec!["grade", &file, only, "--export=junit:no/such/folder/x.xml"],
        vec!["export", &broken, "--format=junit"],
        vec!["export", "nowhere.json", "--format=junit"],
    ] {
        let output = grader(folder.path(), &arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", text(&output.stderr));
    }
}

#[test]
#[cfg(unix)]
fn gradescope_s_script_gives_results_also_where_there_is_nothing_to_grade() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let submission = folder.path().join("submission");
    std::fs::create_dir(&submission).expect("it can be made");
    let script = root().join("grader/lab/src/handout/gradescope/run_autograder");
    let run = || {
        let mut bash = Command::new("bash");
        bash.arg(&script)
            .env("AUTOGRADER_ROOT", folder.path())
            .env("GRADER", env!("CARGO_BIN_EXE_grader"))
            .env("ALLOW_SANDBOX", "none")
            .env_remove("GITHUB_ACTIONS")
            .env_remove("GITHUB_STEP_SUMMARY");
        let output = bash.output().expect("bash starts");
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        let results = read(&folder.path().join("results/results.json"));
        serde_json::from_str::<serde_json::Value>(&results)
            .unwrap_or_else(|error| panic!("{error}: {results}"))
    };
    std::fs::create_dir(submission.join("a\"\\b\n")).expect("it can be made");
    let nothing = run();
    assert_eq!(nothing["score"], 0.0);
    assert!(nothing["output"].as_str().is_some_and(|why| why.contains("render_pt.rs")), "{nothing}");

    // The file counts, and not the repository that came with it.
    std::fs::create_dir_all(submission.join(".git/objects")).expect("it can be made");
    std::fs::create_dir_all(submission.join(".git/refs")).expect("it can be made");
    std::fs::write(submission.join(".git/HEAD"), "ref: refs/heads/main").expect("it can be written");
    std::fs::write(submission.join("render_pt.rs"), "fn broken() {").expect("it can be written");
    let metadata =
        r#"{"created_at": "2026-11-20T11:20:00Z", "assignment": {"due_date": "2026-11-20T10:00:00Z"}}"#;
    std::fs::write(folder.path().join("submission_metadata.json"), metadata).expect("it can be written");
    let broken = run();
    assert_eq!(broken["score"], 0.0);
    let output = broken["output"].as_str().expect("a text");
    assert!(
        output.contains("does not compile") && output.contains("received 1:20 h after the deadline"),
        "{output}"
    );

    std::fs::write(folder.path().join("submission_metadata.json"), "{}}").expect("it can be written");
    assert_eq!(run()["score"], 0.0, "metadata that cannot be read cost no results");
}

#[test]
fn shells_get_completions() {
    for (shell, sign) in [("bash", "complete -F"), ("zsh", "#compdef grader"), ("fish", "complete -c grader")]
    {
        let output = grader(&root(), &["completions", shell]);
        assert!(text(&output.stdout).contains(sign), "{shell}");
    }
}

/// What is on the search path of a student is Cargo alone.
#[test]
#[cfg(unix)]
fn bash_completes_the_commands_of_cargo() {
    let script = text(&grader(&root(), &["completions", "bash"]).stdout).to_owned();
    let complete = |line: &str| -> Vec<String> {
        let words: Vec<&str> = line.split(' ').collect();
        let (last, before) = (words[words.len() - 1], words[words.len() - 2]);
        let call = format!(
            "{script}\nCOMP_WORDS=({line})\n[ -n '{last}' ] || COMP_WORDS+=('')\nCOMP_CWORD={}\n_arty_of_cargo cargo '{last}' \
             '{before}'\nprintf '%s\\n' \"${{COMPREPLY[@]}}\"",
            words.len() - 1
        );
        let bash = Command::new("bash").args(["--norc", "-c", &call]).output().expect("bash starts");
        text(&bash.stdout).lines().map(str::to_owned).collect()
    };
    assert!(complete("cargo grade --wat").contains(&"--watch".to_owned()));
    assert!(complete("cargo hint --rep").contains(&"--report".to_owned()));
    assert!(complete("cargo grader rep").contains(&"replay".to_owned()));
    assert!(complete("cargo grader replay --pix").contains(&"--pixel".to_owned()));
    assert!(complete("cargo arty --tech").contains(&"--technique".to_owned()));
    assert!(complete("cargo arty --technique ").contains(&"nee".to_owned()));
}
