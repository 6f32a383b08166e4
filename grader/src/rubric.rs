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
    /// In which scene; [`SCRIPTED`] for the kinds that make their own.
    #[serde(default = "scripted")]
    pub scene: String,
    /// With which technique of the hand-in.
    pub technique: Technique,
    /// The largest number of bounces.
    pub max_bounces: u32,
    /// `off` if lights that a path hits emit nothing, so that only next event estimation finds light.
    #[serde(default)]
    pub hits: Hits,
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

/// The name that stands for the scene of checks that make their own.
pub const SCRIPTED: &str = "scripted";

/// Whether lights that a path hits emit anything.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Hits {
    /// They do not: what is left is next event estimation alone.
    Off,
    /// They do, as ever.
    #[default]
    On,
}

/// Which light a picture shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct View {
    /// The largest number of bounces.
    pub max_bounces: u32,
    /// Whether lights that are hit count.
    pub hits: Hits,
}

/// The kinds of checks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CheckKind {
    /// Means against a reference image.
    MeanBias,
    /// Means against the closed form of a uniformly emitting enclosure.
    WhiteFurnace,
    /// The weights of multiple importance sampling, one by one; `max_bounces` is the longest path that is looked at.
    MisWeights,
    /// Scenes and densities at the ends of what numbers can be.
    Stability,
}

impl CheckKind {
    /// Its name in rubrics, reports and on command lines.
    pub fn name(self) -> &'static str {
        match self {
            Self::MeanBias => "mean-bias",
            Self::WhiteFurnace => "white-furnace",
            Self::MisWeights => "mis-weights",
            Self::Stability => "stability",
        }
    }

    /// True if it is looked at in a scene of the collection.
    pub fn needs_scene(self) -> bool {
        !matches!(self, Self::MisWeights | Self::Stability)
    }
}

impl CheckSpec {
    /// What tells this check from all others: `mean-bias/cornell_box/nee/8`.
    pub fn id(&self) -> String {
        let hits = if self.hits == Hits::Off { "/hits-off" } else { "" };
        format!("{}/{}/{}/{}{hits}", self.check.name(), self.scene, self.technique, self.max_bounces)
    }

    /// Which light its pictures show.
    pub fn view(&self) -> View {
        View { max_bounces: self.max_bounces, hits: self.hits }
    }
}

fn scripted() -> String {
    SCRIPTED.to_owned()
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
                if check.check.needs_scene() == (check.scene == SCRIPTED) {
                    let what = if check.check.needs_scene() { "needs a `scene`" } else { "takes no `scene`" };
                    return Err(format!("task {id}, {}: {what}", check.id()));
                }
                if check.hits == Hits::Off
                    && (check.check, check.technique) != (CheckKind::MeanBias, Technique::Nee)
                {
                    return Err(format!(
                        "task {id}, {}: `hits: off` goes with mean-bias and nee only",
                        check.id()
                    ));
                }
                if check.check == CheckKind::MisWeights
                    && (check.technique != Technique::Mis || !(1..=3).contains(&check.max_bounces))
                {
                    return Err(format!(
                        "task {id}, {}: mis-weights goes with the technique mis and 1 to 3 bounces only",
                        check.id()
                    ));
                }
                if check.check == CheckKind::Stability && check.technique == Technique::Bsdf {
                    return Err(format!("task {id}, {}: stability goes with nee and mis only", check.id()));
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

    /// For each scene that is checked: for each picture of it the techniques.
    pub fn scenes(&self) -> BTreeMap<&str, BTreeMap<View, Vec<Technique>>> {
        let mut scenes: BTreeMap<&str, BTreeMap<View, Vec<Technique>>> = BTreeMap::new();
        for (_, check) in self.checks().filter(|(_, check)| check.check.needs_scene()) {
            let techniques = scenes.entry(&check.scene).or_default().entry(check.view()).or_default();
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
            (
                task("checks: [{check: mis-weights, technique: nee, max_bounces: 3, evidence: true}]"),
                "the technique mis",
            ),
            (
                task("checks: [{check: mean-bias, technique: nee, max_bounces: 3, evidence: true}]"),
                "needs a `scene`",
            ),
            (task(&format!("checks: [{CHECK}, evidence: true, hits: no}}]")), "rubric.yml:4: "),
            ("tasks: [".to_owned(), "rubric.yml:"),
        ] {
            let message = load(&text).expect_err(expected);
            assert!(message.contains(expected), "{message}");
        }
        assert!(load(&task(&format!("checks: [{CHECK}, evidence: true}}]"))).is_ok());
    }
}
