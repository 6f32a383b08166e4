//! A folder with a rubric and a class, and the program as tutors call it.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

const RUBRIC: &str = "
assignment: tiny
title: One cheap check
submission: { file: skeleton/src/algorithms/render_pt.rs, contract: path-tracer, solution: solution/src/algorithms/render_pt.rs }
techniques: [bsdf, nee, mis]
reference_technique: mis
policy:
  time_zone: Europe/Berlin
  late: { less_than_hours: 2, factor: 0.8 }
  md5: { within_hours: 12 }
tasks:
  - id: '1'
    title: A point light
    points: 10
    checks:
      - { check: mean-bias, scene: point_plane, technique: mis, max_bounces: 1, required: true, tolerance: 0.01 }
  - { id: '2', title: Why, points: 5, manual: true }
";

/// A folder with a rubric and a class.
pub(crate) struct Course(tempfile::TempDir);

impl Course {
    pub(crate) fn new(submissions: &[(&str, &str)]) -> Self {
        let course = Self(tempfile::tempdir().expect("a temporary folder"));
        course.write("rubric/rubric.yml", RUBRIC);
        course.write("rubric/starter.rs", &starter());
        for (name, source) in submissions {
            course.write(&format!("class/{name}"), source);
        }
        course
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub(crate) fn write(&self, name: &str, text: &str) {
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().expect("it has one")).expect("it can be made");
        std::fs::write(path, text).expect("it can be written");
    }

    pub(crate) fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_grader"));
        command.args(["class", "class", "--no-report", "--assignment"]).arg(self.path("rubric"));
        command.args(arguments).current_dir(self.0.path());
        command
    }

    pub(crate) fn run(&self, arguments: &[&str]) -> String {
        let output = self.command(arguments).output().expect("the program starts");
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        String::from_utf8_lossy(&output.stdout).into_owned()
    }

    /// What is said when it ends with this status.
    pub(crate) fn fails(&self, arguments: &[&str], status: i32) -> String {
        let output = self.command(arguments).output().expect("the program starts");
        assert_eq!(output.status.code(), Some(status), "{}", stderr(&output));
        stderr(&output)
    }

    /// Another command than `class`.
    pub(crate) fn other(&self, arguments: &[&str]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_grader"));
        command.args(arguments).arg("--assignment").arg(self.path("rubric")).current_dir(self.0.path());
        command.output().expect("the program starts")
    }

    pub(crate) fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).expect(name)
    }

    /// For each student state, reason and points; nothing that a clock decides.
    pub(crate) fn results(&self, out: &str) -> BTreeMap<String, (String, String, Option<f64>)> {
        let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
        let class: Value =
            serde_json::from_slice(&std::fs::read(self.path(out).join("class.json")).expect("it is there"))
                .expect("it is JSON");
        let rows = class["rows"].as_array().expect("there are rows");
        rows.iter()
            .map(|row| {
                (
                    text(&row["key"]),
                    (text(&row["state"]), text(&row["reason"]["code"]), row["points"].as_f64()),
                )
            })
            .collect()
    }

    pub(crate) fn records(&self, out: &str) -> Vec<PathBuf> {
        let folders = std::fs::read_dir(self.path(out).join("submissions")).into_iter().flatten().flatten();
        folders.map(|folder| folder.path().join("record.json")).filter(|file| file.is_file()).collect()
    }
}

pub(crate) fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn read(path: &str) -> String {
    std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)).expect("it is there")
}

pub(crate) fn solution() -> String {
    read("solution/src/algorithms/render_pt.rs")
}

pub(crate) fn starter() -> String {
    read("assignments/05-nee-mis/starter.rs")
}

/// A submission whose `radiance` does this.
pub(crate) fn that_does(what: &str) -> String {
    format!(
        "use arty::prelude::*;\npub struct PathTracer;\nimpl PathTracer {{ pub fn new(_: Settings) -> Self {{ Self }} }}\n\
         impl Integrator for PathTracer {{ fn radiance(&self, _: &Scene, _: Ray, _: &mut Sampler) -> Rgb {{ {what} }} }}\n"
    )
}
