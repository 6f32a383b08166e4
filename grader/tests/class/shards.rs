//! A class on several machines.

use std::collections::BTreeMap;

use serde_json::Value;

use crate::course::{Course, solution, starter, stderr};

const SHARDS: [&str; 3] = ["--shard=1/3", "--shard=2/3", "--shard=3/3"];

fn course() -> Course {
    let solution = solution();
    let course = Course::new(&[("dan/render_pt.rs", "fn main( {"), ("eve/why.txt", "because")]);
    for name in ["ann", "bob", "cem", "fay", "gus"] {
        course.write(&format!("class/{name}/render_pt.rs"), &solution);
    }
    course.write("class/hal/render_pt.rs", &starter());
    course.write("roster.csv", "login\nzoe\nhal\ngus\nfay\neve\ndan\ncem\nbob\nann\n");
    course.write("course.yml", "deadline: 2026-05-21 23:59\n");
    course.write("received.csv", "student,received_at\nann,2026-05-22 01:00\nbob,2026-05-21 12:00\n");
    course
}

fn arguments<'a>(more: &[&'a str]) -> Vec<&'a str> {
    let always = ["--roster=roster.csv", "--manifest=received.csv", "--course=course.yml"];
    [&always[..], more].concat()
}

/// A file of results without times.
fn without_times(course: &Course, file: &str) -> Value {
    let mut class: Value = serde_json::from_str(&course.read(file)).expect("it is JSON");
    for row in class["rows"].as_array_mut().expect("there are rows") {
        row["graded_at"] = Value::Null;
    }
    class
}

/// All tables of a run; `graded_at` is the last column.
pub(crate) fn tables(course: &Course, out: &str) -> BTreeMap<&'static str, String> {
    let gradebook = course.read(&format!("{out}/gradebook.csv"));
    let gradebook: Vec<&str> =
        gradebook.lines().map(|line| line.rsplit_once(',').map_or(line, |(rest, _)| rest)).collect();
    BTreeMap::from([
        ("gradebook.csv", gradebook.join("\n")),
        ("similar.txt", course.read(&format!("{out}/similar.txt"))),
        ("class.json", without_times(course, &format!("{out}/class.json")).to_string()),
    ])
}

fn merge(course: &Course, out: &str) -> (Option<i32>, String) {
    let output = course.other(&["merge", "--no-report", &format!("--out={out}")]);
    (output.status.code(), stderr(&output))
}

#[test]
fn merged_shards_equal_the_tables_of_one_machine() {
    let course = course();
    course.run(&arguments(&["--out=one"]));
    for shard in SHARDS {
        course.run(&arguments(&["--out=many", shard]));
    }
    let (status, told) = merge(&course, "many");
    assert_eq!(status, Some(0), "{told}");
    assert!(told.contains("sandbox: "), "the weakest level is named: {told}");
    assert_eq!(tables(&course, "many"), tables(&course, "one"));

    // Marks and records of the merged class are used from then on.
    let output = course.other(&["mark", "eve", "2", "5", "--out=many"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(merge(&course, "many").0, Some(0));
    assert_eq!(course.results("many")["eve"].2, Some(5.0));
    let told = course.run(&arguments(&["--out=many", "--resume"]));
    assert!(told.contains("0 graded now, 7 unchanged"), "{told}");
    assert_eq!(course.results("many")["eve"].2, Some(5.0));
}

#[test]
fn shards_that_are_not_of_one_class_are_refused_by_name() {
    let course = course();
    for shard in &SHARDS[..2] {
        course.run(&arguments(&["--out=many", shard]));
    }
    let refused = |expected: &str| {
        let (status, told) = merge(&course, "many");
        assert!(status == Some(2) && told.contains(expected), "{status:?} {told}");
        assert!(!course.path("many/gradebook.csv").exists());
    };
    refused("of 3 shards, these are missing: 3");
    for (more, expected) in [
        ("--seed=2", "shard 3 of 3 was graded with another seed than shard 1 of 3"),
        ("--only=1", "another --only"),
        ("--received-at=2026-05-21 12:00", "receipt times"),
    ] {
        course.run(&arguments(&["--out=many", "--shard=3/3", "--regrade", more]));
        refused(expected);
    }
    course.write("roster.csv", &course.read("roster.csv").replace("zoe\n", ""));
    course.run(&arguments(&["--out=many", "--shard=3/3", "--regrade"]));
    refused("another roster");
    std::fs::remove_file(course.path("many/shard-3-of-3/shard.json")).expect("it is there");
    refused("has not been graded to its end");
}
