//! The templates for a class on several machines, each script run as its system runs it, with nothing but paths changed.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

use crate::course::{Course, stderr};

fn template(name: &str) -> serde_yaml::Value {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../assignments/05-nee-mis/ci");
    let text = std::fs::read_to_string(folder.join(name)).expect("the template is there");
    serde_yaml::from_str(&text).expect("it is YAML")
}

/// A class whose submissions cost nothing but an attempt to compile them, in the folders that the templates name.
fn course(folder: &str) -> Course {
    let course = Course::new(&[]);
    let file = |name: &str| if folder.is_empty() { name.to_owned() } else { format!("{folder}/{name}") };
    for name in ["ann", "bob", "cem", "dee"] {
        let source = format!("pub struct PathTracer; // {name}\nfn main( {{");
        course.write(&file(&format!("submissions/{name}/render_pt.rs")), &source);
    }
    course.write(&file("roster.csv"), "login\nann\nbob\ncem\ndee\nzoe\n");
    course.write(&file("received.csv"), "student,received_at\nann,2026-05-22 01:00\n");
    course.write(&file("course.yml"), "deadline: 2026-05-21 23:59\n");
    course
}

/// Runs a script where `cargo grader` is the grader under test.
fn run(course: &Course, script: &str, environment: &[(&str, &str)]) -> Output {
    let shim = format!("#!/bin/sh\nshift\nexec '{}' \"$@\"\n", env!("CARGO_BIN_EXE_grader"));
    course.write("tools/cargo", &shim);
    let made = Command::new("chmod").arg("+x").arg(course.path("tools/cargo")).status();
    assert!(made.expect("chmod is there").success());
    let path = std::env::var("PATH").expect("there is a search path");
    let mut bash = Command::new("bash");
    bash.args(["-e", "-o", "pipefail", "-c", script])
        .current_dir(course.path("."))
        .env("PATH", format!("{}:{path}", course.path("tools").display()))
        .envs(environment.iter().copied());
    bash.output().expect("bash starts")
}

/// Asserts that a class was graded as the templates ask for.
fn assert_graded(course: &Course, out: &str) {
    let results = course.results(out);
    let codes: Vec<_> = results.iter().map(|(key, (_, code, _))| (key.as_str(), code.as_str())).collect();
    assert_eq!(
        codes,
        [("ann", "build"), ("bob", "build"), ("cem", "build"), ("dee", "build"), ("zoe", "missing")]
    );
    let class: Value = serde_json::from_str(&course.read(&format!("{out}/class.json"))).expect("it is JSON");
    assert_eq!(class["rows"][0]["received_at"], "2026-05-21T23:00:00Z");
}

#[test]
fn the_workflow_of_github_grades_and_merges() {
    let course = course("class");
    let workflow = template("class-github.yml");
    let step = |job: &str, name: &str| -> String {
        let steps = workflow["jobs"][job]["steps"].as_sequence().expect("there are steps");
        let step = steps.iter().find(|step| step["name"] == name).expect("there is such a step");
        step["run"].as_str().expect("it runs a script").to_owned()
    };
    let shards = workflow["jobs"]["shard"]["strategy"]["matrix"]["shard"].as_sequence().expect("a list");
    for shard in shards.iter().map(|shard| shard.as_u64().expect("a number").to_string()) {
        let script = step("shard", "Grade").replace("${{ matrix.shard }}", &shard);
        let output = run(&course, &script, &[]);
        assert!(output.status.success(), "{}", stderr(&output));
        // What the artifact holds goes to a folder of its name.
        let artifact = course.path(&format!("shards/shard-{shard}"));
        std::fs::create_dir_all(course.path("shards")).expect("it can be made");
        std::fs::rename(course.path(&format!("class-report/shard-{shard}-of-4")), artifact)
            .expect("it is there");
    }
    let output = run(&course, &step("merge", "Merge"), &[]);
    assert!(output.status.success(), "{}", stderr(&output));
    assert_graded(&course, "class-report");
}

#[test]
fn the_pipeline_of_gitlab_grades_and_merges() {
    let course = course("class");
    let pipeline = template("class-gitlab.yml");
    let script = |job: &str| pipeline[job]["script"][0].as_str().expect("a script").to_owned();
    let total = pipeline["shard"]["parallel"].as_u64().expect("a number");
    for index in 1..=total {
        let environment = [("CI_NODE_INDEX", index.to_string()), ("CI_NODE_TOTAL", total.to_string())];
        let environment = environment.each_ref().map(|(name, value)| (*name, value.as_str()));
        let output = run(&course, &script("shard"), &environment);
        assert!(output.status.success(), "{}", stderr(&output));
    }
    let output = run(&course, &script("merge"), &[]);
    assert!(output.status.success(), "{}", stderr(&output));
    assert_graded(&course, "class-report");
}

#[test]
fn the_containers_of_kubernetes_grade_and_merge() {
    let course = course("");
    let arty: PathBuf = course.path("arty");
    std::fs::create_dir_all(arty.join("target/release")).expect("it can be made");
    #[cfg(unix)]
    std::os::unix::fs::symlink(env!("CARGO_BIN_EXE_grader"), arty.join("target/release/grader"))
        .expect("it can be linked");
    let volume = course.path(".").display().to_string();
    let text =
        |value: &serde_yaml::Value| value.as_str().expect("a text").replace("/class/", &format!("{volume}/"));
    let container = |job: &serde_yaml::Value| -> Vec<String> {
        let container = &job["spec"]["template"]["spec"]["containers"][0];
        let parts = [&container["command"], &container["args"]];
        parts.into_iter().filter_map(serde_yaml::Value::as_sequence).flatten().map(text).collect()
    };
    let job = template("class-kubernetes.yml");
    let completions = job["spec"]["completions"].as_u64().expect("a number");
    let start = |command: &[String], index: u64| {
        let mut program = Command::new(&command[0]);
        program.args(&command[1..]).current_dir(&arty).env("JOB_COMPLETION_INDEX", index.to_string());
        let output = program.output().expect("it starts");
        assert!(output.status.success(), "{}", stderr(&output));
    };
    (0..completions).for_each(|index| start(&container(&job), index));
    start(&container(&template("class-kubernetes-merge.yml")), 0);
    // The container of the merge names the report with its option.
    assert_graded(&course, "report");
}
