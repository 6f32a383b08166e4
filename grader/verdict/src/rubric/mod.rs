//! The rubric of an assignment: its tasks, their points and their checks.

use std::collections::BTreeMap;
use std::path::Path;

use arty::integrator::Technique;
use schemars::JsonSchema;
use serde::Deserialize;

use crate::check::CheckKind;
use crate::error::{Error, Result};
use crate::report::Step;
use crate::schema::TechniqueName;

mod check;
mod rules;
mod student_file;

pub use check::{CheckSpec, EmissionOnHit, SCRIPTED, View, rivals};
pub use rules::{LateRule, Md5Rule, Rules, zone};
pub use student_file::{Contract, StudentFile};

/// The contents of `rubric.yml`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rubric {
    /// Name of the assignment: that of its folder.
    pub assignment: String,
    /// Title of the assignment.
    pub title: String,
    /// File that students hand in, and its contract.
    pub submission: StudentFile,
    /// Techniques that the program offers, in the order of pictures. The first is what it had before: the baseline.
    #[schemars(with = "Vec<TechniqueName>")]
    pub techniques: Vec<Technique>,
    /// Techniques that students write; those of all checks if it is missing.
    #[serde(default)]
    #[schemars(with = "Option<Vec<TechniqueName>>")]
    student_techniques: Option<Vec<Technique>>,
    /// Technique that the solution renders references and pictures with.
    #[schemars(with = "TechniqueName")]
    pub reference_technique: Technique,
    /// What to begin with, for those who have not begun.
    #[serde(default)]
    pub begin: String,
    /// Scenes of the pictures of a report, beside those that are wrong.
    #[serde(default)]
    pub pictures: Vec<String>,
    /// How to recognise techniques that a submission has not begun.
    #[serde(default)]
    pub not_begun: Vec<NotBegun>,
    /// Rules for late submissions; without them, no submission is late.
    #[serde(default)]
    pub policy: Option<Rules>,
    /// Tasks, in the order of the sheet.
    pub tasks: Vec<Task>,
}

/// A technique counts as not begun if the source never names it outside of comments, and its weights are constant.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NotBegun {
    /// The technique.
    #[schemars(with = "TechniqueName")]
    pub technique: Technique,
    /// Its name in a source.
    pub name: String,
    /// Hint for a student who has not begun.
    #[serde(default)]
    pub hint: String,
}

/// One task of the sheet.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Task {
    /// Number of the task on the sheet.
    pub id: String,
    /// Title of the task.
    pub title: String,
    /// Maximum points.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub points: f64,
    /// True if a tutor grades it. Then it has no checks.
    #[serde(default)]
    pub manual: bool,
    /// Tasks whose required checks must pass, too: otherwise this task earns no points.
    #[serde(default)]
    pub requires: Vec<String>,
    /// The checks. Each carries an equal share of the points, multiplied by its `weight`.
    #[serde(default)]
    pub checks: Vec<CheckSpec>,
}

impl Task {
    /// The steps, each with its checks. Checks before the first step belong to none; a step that is named again goes on.
    pub fn steps(&self) -> Vec<Step> {
        let mut steps: Vec<Step> = Vec::new();
        let mut current = None;
        for check in &self.checks {
            if let Some(title) = &check.step {
                let known = steps.iter().position(|step| step.title == *title);
                current = Some(known.unwrap_or(steps.len()));
                if known.is_none() {
                    steps.push(Step { title: title.clone(), checks: Vec::new() });
                }
            }
            if let Some(step) = current.and_then(|index| steps.get_mut(index)) {
                step.checks.push(check.id());
            }
        }
        steps
    }
}

impl Rubric {
    /// Reads and validates the rubric of an assignment.
    pub fn load(path: &Path) -> Result<Self> {
        let (rubric, _) = arty::yaml::read::<Self>(path)?;
        rubric.validate().map_err(|message| Error::file(path, message))?;
        Ok(rubric)
    }

    fn validate(&self) -> std::result::Result<(), String> {
        self.policy.as_ref().map_or(Ok(()), Rules::validate)?;
        self.submission.validate()?;
        if !self.techniques.contains(&self.reference_technique) {
            let wanted = self.reference_technique;
            return Err(format!("`reference_technique` is {wanted}, which is not one of `techniques`"));
        }
        for task in &self.tasks {
            let id = &task.id;
            if !(task.points.is_finite() && task.points > 0.0) {
                return Err(format!("task {id}: `points` must be a positive number"));
            }
            if task.manual != task.checks.is_empty() {
                return Err(format!("task {id}: give either `manual: true` or a list of `checks`"));
            }
            if !task.manual && !task.checks.iter().any(|check| check.required) {
                return Err(format!(
                    "task {id}: mark a check with `required: true`, or the untouched starting file earns points"
                ));
            }
            for required in &task.requires {
                let known = self.tasks.iter().any(|other| other.id == *required && !other.manual);
                if !known || required == id {
                    return Err(format!(
                        "task {id}: `requires` names `{required}`, which is not another task with checks"
                    ));
                }
            }
            for check in &task.checks {
                if !self.techniques.contains(&check.technique) {
                    return Err(format!(
                        "task {id}, {}: this technique is not one of `techniques`",
                        check.id()
                    ));
                }
                if check.check == CheckKind::Sampling
                    && self.submission.contract != Contract::EnvironmentSampler
                {
                    return Err(format!(
                        "task {id}, {}: it needs the contract `environment-sampler`",
                        check.id()
                    ));
                }
                check.validate().map_err(|message| format!("task {id}, {}: {message}", check.id()))?;
            }
            if let Some(twice) = task.checks.iter().enumerate().find_map(|(index, check)| {
                let earlier = &task.checks[..index];
                earlier.iter().any(|other| other.id() == check.id()).then(|| check.id())
            }) {
                return Err(format!("task {id}: {twice} is listed twice"));
            }
        }
        Ok(())
    }

    /// The techniques that students write, in the order of all techniques.
    pub fn student_techniques(&self) -> Vec<Technique> {
        let is_graded = |technique: &Technique| self.checks().any(|(_, spec)| spec.technique == *technique);
        match &self.student_techniques {
            Some(named) => named.clone(),
            None => self.techniques.iter().copied().filter(is_graded).collect(),
        }
    }

    /// The technique that others are compared with; `None` if there is no other.
    pub fn baseline(&self) -> Option<Technique> {
        self.techniques.first().copied().filter(|&first| first != self.reference_technique)
    }

    /// All checks, each with its task.
    pub fn checks(&self) -> impl Iterator<Item = (&Task, &CheckSpec)> {
        self.tasks.iter().flat_map(|task| task.checks.iter().map(move |check| (task, check)))
    }

    /// True if the audit has something to say: its facts are about light samples and what they are combined with.
    pub fn is_audited(&self) -> bool {
        self.checks().any(|(_, spec)| spec.technique != Technique::Bsdf)
    }

    /// The views that the reference of each scene needs, with the techniques whose noise it has to record.
    pub fn scenes(&self) -> BTreeMap<&str, BTreeMap<View, Vec<Technique>>> {
        let mut scenes: BTreeMap<&str, BTreeMap<View, Vec<Technique>>> = BTreeMap::new();
        for (_, check) in self.checks().filter(|(_, check)| check.check.needs_scene()) {
            let views = scenes.entry(&check.scene).or_default();
            if check.check.draws_scenes() {
                continue;
            }
            let techniques = views.entry(check.view()).or_default();
            for technique in check.techniques() {
                if !techniques.contains(&technique) {
                    techniques.push(technique);
                }
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

    const HEAD: &str = "assignment: a\ntitle: t\nsubmission: {file: a/x.rs, contract: path-tracer}\n\
        techniques: [bsdf, nee]\nreference_technique: nee\n";

    const CHECK: &str = "{check: mean-bias, scene: a, technique: nee, max_bounces: 1";

    #[test]
    fn each_mistake_in_a_rubric_has_its_own_message() {
        let task = |rest: &str| format!("{HEAD}tasks:\n- {{id: x, title: t, points: 1, {rest}}}\n");
        for (text, expected) in [
            (task("manual: false"), "either `manual: true` or a list of `checks`"),
            (task(&format!("checks: [{CHECK}}}]")), "required: true"),
            (task(&format!("checks: [{CHECK}, required: true, weight: -1}}]")), "`weight` must be"),
            (task(&format!("checks: [{CHECK}, required: true, tolerance: 2}}]")), "`tolerance` must be"),
            (task(&format!("checks: [{CHECK}, required: true, colour: 2}}]")), "rubric.yml:7: "),
            (task(&format!("checks: [{CHECK}, evidence: true}}]")), "`evidence` is now called `required`"),
            (
                task(&format!("checks: [{CHECK}, required: true, hits: off}}]")),
                "`hits` is now called `emission_on_hit`",
            ),
            (
                task("checks: [{check: mean-bias, technique: nee, max_bounces: 3, required: true}]"),
                "needs a `scene`",
            ),
            (task(&format!("checks: [{CHECK}, required: true, emission_on_hit: no}}]")), "rubric.yml:7: "),
            (
                task(
                    "checks: [{check: mean-bias, scene: a, technique: mis, max_bounces: 3, required: true}]",
                ),
                "not one of `techniques`",
            ),
            (
                task("checks: [{check: sampling, technique: nee, max_bounces: 1, required: true}]"),
                "needs the contract `environment-sampler`",
            ),
            ("tasks: [".to_owned(), "rubric.yml:"),
        ] {
            let message = load(&text).expect_err(expected);
            assert!(message.contains(expected), "{message}");
        }
        assert!(load(&task(&format!("checks: [{CHECK}, required: true}}]"))).is_ok());
    }

    #[test]
    fn a_step_begins_with_the_check_that_names_it() {
        let mut task = Task {
            id: "x".to_owned(),
            title: "t".to_owned(),
            points: 1.0,
            manual: false,
            requires: Vec::new(),
            checks: (1..=5)
                .map(|bounces| CheckSpec::new(CheckKind::LightPick, Technique::Nee, bounces))
                .collect(),
        };
        assert!(task.steps().is_empty());
        for (check, step) in [(1, "one"), (2, "two"), (4, "one")] {
            task.checks[check].step = Some(step.to_owned());
        }
        let bounces = |step: &Step| step.checks.iter().map(|id| id.max_bounces).collect::<Vec<_>>();
        let steps: Vec<_> = task.steps().iter().map(|step| (step.title.clone(), bounces(step))).collect();
        assert_eq!(steps, [("one".to_owned(), vec![2, 5]), ("two".to_owned(), vec![3, 4])]);
    }
}
