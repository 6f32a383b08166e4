//! What an assignment asks for, and what it is worth.

use std::collections::BTreeMap;
use std::path::Path;

use arty::integrator::Technique;
use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};

/// The contents of `rubric.yml`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rubric {
    /// The assignment's name: that of its folder.
    pub assignment: String,
    /// Its title.
    pub title: String,
    /// The tasks, in the order of the sheet.
    pub tasks: Vec<Task>,
}

/// One task of the sheet.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Task {
    /// Its number on the sheet.
    pub id: String,
    /// What it is about.
    pub title: String,
    /// Points for all of it.
    pub points: f64,
    /// True if a person marks it. Then it has no checks.
    #[serde(default)]
    pub manual: bool,
    /// What is looked at. Each check carries the same share of the points, or `weight` times as much.
    #[serde(default)]
    pub checks: Vec<CheckSpec>,
}

/// One check of a task.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CheckSpec {
    /// Which kind of check.
    pub check: CheckKind,
    /// In which scene.
    pub scene: String,
    /// With which technique of the hand-in.
    pub technique: Technique,
    /// The largest number of bounces.
    pub max_bounces: u32,
    /// How many shares of the task's points it carries.
    #[serde(default = "one")]
    pub weight: f64,
    /// True if the task earns nothing without it: an untouched starting file must fail such a check.
    #[serde(default)]
    pub evidence: bool,
    /// The relative error of the whole image's mean that a pass excludes.
    #[serde(default = "two_percent")]
    pub tolerance: f64,
}

/// The kinds of checks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CheckKind {
    /// Means against a reference image.
    MeanBias,
    /// Means against the closed form of a uniformly emitting enclosure.
    WhiteFurnace,
}

impl CheckKind {
    /// Its name in rubrics, reports and on command lines.
    pub fn name(self) -> &'static str {
        match self {
            Self::MeanBias => "mean-bias",
            Self::WhiteFurnace => "white-furnace",
        }
    }
}

impl CheckSpec {
    /// What tells this check from all others: `mean-bias/cornell_box/nee/8`.
    pub fn id(&self) -> String {
        format!("{}/{}/{}/{}", self.check.name(), self.scene, self.technique, self.max_bounces)
    }
}

fn one() -> f64 {
    1.0
}

fn two_percent() -> f64 {
    0.02
}

impl Rubric {
    /// Reads the rubric of an assignment.
    pub fn load(path: &Path) -> Result<Self> {
        let (rubric, _) = arty::yaml::read::<Self>(path)?;
        rubric.validate().map_err(|message| Error::file(path, message))?;
        Ok(rubric)
    }

    fn validate(&self) -> std::result::Result<(), String> {
        for task in &self.tasks {
            let id = &task.id;
            if !(task.points.is_finite() && task.points > 0.0) {
                return Err(format!("task {id}: `points` must be a positive number"));
            }
            if task.manual != task.checks.is_empty() {
                return Err(format!("task {id}: either `manual: true` or a list of `checks`"));
            }
            if !task.manual && !task.checks.iter().any(|check| check.evidence) {
                return Err(format!(
                    "task {id}: at least one check with `evidence: true`, or an untouched file earns points"
                ));
            }
            for check in &task.checks {
                if !(check.weight.is_finite() && check.weight > 0.0) {
                    return Err(format!("task {id}, {}: `weight` must be a positive number", check.id()));
                }
                if !(check.tolerance > 0.0 && check.tolerance < 1.0) {
                    return Err(format!("task {id}, {}: `tolerance` must be between 0 and 1", check.id()));
                }
            }
        }
        Ok(())
    }

    /// All checks with the task they belong to.
    pub fn checks(&self) -> impl Iterator<Item = (&Task, &CheckSpec)> {
        self.tasks.iter().flat_map(|task| task.checks.iter().map(move |check| (task, check)))
    }

    /// For each scene that is checked: by the largest number of bounces, the techniques.
    pub fn scenes(&self) -> BTreeMap<&str, BTreeMap<u32, Vec<Technique>>> {
        let mut scenes: BTreeMap<&str, BTreeMap<u32, Vec<Technique>>> = BTreeMap::new();
        for (_, check) in self.checks() {
            let techniques = scenes.entry(&check.scene).or_default().entry(check.max_bounces).or_default();
            if !techniques.contains(&check.technique) {
                techniques.push(check.technique);
            }
        }
        scenes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn load(text: &str) -> std::result::Result<Rubric, String> {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("rubric.yml");
        std::fs::write(&path, text).expect("it can be written");
        Rubric::load(&path).map_err(|error| error.to_string())
    }

    const CHECK: &str = "{check: mean-bias, scene: a, technique: nee, max_bounces: 1";

    #[test]
    fn a_wrong_rubric_is_one_clear_error() {
        let task = |rest: &str| {
            format!("assignment: a\ntitle: t\ntasks:\n- {{id: x, title: t, points: 1, {rest}}}\n")
        };
        for (text, expected) in [
            (task("manual: false"), "either `manual: true` or a list of `checks`"),
            (task(&format!("checks: [{CHECK}}}]")), "evidence: true"),
            (task(&format!("checks: [{CHECK}, evidence: true, weight: -1}}]")), "`weight` must be"),
            (task(&format!("checks: [{CHECK}, evidence: true, tolerance: 2}}]")), "`tolerance` must be"),
            (task(&format!("checks: [{CHECK}, evidence: true, colour: 2}}]")), "rubric.yml:4: "),
            ("tasks: [".to_owned(), "rubric.yml:"),
        ] {
            let message = load(&text).expect_err(expected);
            assert!(message.contains(expected), "{message}");
        }
        assert!(load(&task(&format!("checks: [{CHECK}, evidence: true}}]"))).is_ok());
    }
}
