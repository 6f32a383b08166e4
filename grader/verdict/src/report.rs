//! The report on one grade of one submission. `report.json` holds all of it; every other format is generated from it.

use std::path::Path;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::audit::{Audit, Fact};
use crate::check::{CheckId, CheckKind, CheckResult, Numerics, Verdict, Visibility, WhyNot};
use crate::convergence::Convergence;
use crate::error::{Error, Result};
use crate::output;
use crate::pictures::ImageError;
use crate::sandbox::{Layers, Level};
use crate::submission::{BuildFailure, Explanation, IntakeFinding, SourceFinding};
use arty::integrator::Technique;

/// Name and version of the report format.
pub const SCHEMA: &str = "arty-report/2";

/// The result of grading one submission.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Report {
    /// [`SCHEMA`].
    pub schema: String,
    /// The submission that was graded.
    pub submission: SubmissionInfo,
    /// Name of the assignment.
    pub assignment: String,
    /// Total points.
    pub points: Points,
    /// Points of each task.
    pub tasks: Vec<TaskResult>,
    /// Results of the checks, in the order of the rubric.
    pub checks: Vec<CheckResult>,
    /// Checks that do not apply to their scenes, whatever the submission.
    pub skipped: Vec<SkippedCheck>,
    /// Facts about every factor of the estimator; `None` if they were not measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub audit: Option<Audit>,
    /// Likely causes, most likely first.
    pub diagnosis: Vec<Diagnosis>,
    /// Samples that are not radiance (NaN, infinite or negative), over all checks.
    pub numerics: Numerics,
    /// Time spent, by phase.
    pub cost: Cost,
    /// Confinement of the submission.
    pub sandbox: Sandbox,
    /// Versions and seeds that the grade depends on.
    pub provenance: Provenance,
    /// Error against run time, if it was measured. It does not affect points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub convergence: Option<Convergence>,
    /// Errors of a few pictures against their references, if they were rendered. They do not affect points.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub images: Vec<ImageError>,
    /// Who handed it in, and when, on the pages of a class.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hand_in: Option<HandIn>,
}

/// Who handed a submission in, and when.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct HandIn {
    /// Name of the student, or the login if the name is unknown.
    pub student: String,
    /// Receipt time in the time zone of the course; `None` if it is unknown.
    pub received_at: Option<String>,
    /// Seconds after the deadline; `None` if it was in time or the receipt time is unknown.
    pub late_by: Option<i64>,
    /// Factor for raw points because it was late.
    pub factor: f64,
    /// Points that count, after the penalty, with those of a tutor so far.
    pub points: f64,
}

/// The submission that was graded.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SubmissionInfo {
    /// Its path as given on the command line.
    pub path: String,
    /// BLAKE3 of the source, in hexadecimal.
    pub hash: String,
    /// Why it does not compile; `None` if it does.
    pub build_failure: Option<BuildFailure>,
    /// Written explanations that were sent with it, graded by a tutor.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub explanations: Vec<Explanation>,
    /// Why there was nothing to compile; `None` if there was.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub refusal: Option<IntakeFinding>,
    /// Irregularities that intake noted. They cost no points.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<IntakeFinding>,
    /// Usual name of the source file, by which messages and lines refer to it.
    #[serde(default)]
    pub file_name: String,
    /// Lines of its source that print, counted from 1. Printing costs no points.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub prints: Vec<usize>,
}

/// Total points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Points {
    /// Points earned in the tasks that are graded automatically.
    pub earned: f64,
    /// Maximum points of these tasks.
    pub automatic_max: f64,
    /// Maximum points of the tasks that a tutor grades.
    pub manual_max: f64,
    /// Maximum points of all tasks.
    pub max: f64,
    /// Points given by a tutor so far; `None` if no task has been graded by hand.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub manual: Option<f64>,
    /// The part of `automatic_max` that depends on checks which only staff can run.
    #[serde(default)]
    pub staff_only: f64,
}

/// Points of one task.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TaskResult {
    /// Number of the task on the sheet.
    pub id: String,
    /// Title of the task.
    pub title: String,
    /// Points earned; `None` until a tutor has graded the task, or if some of its checks were not selected.
    pub points: Option<f64>,
    /// Maximum points.
    pub max: f64,
    /// The part of `max` that depends on checks which only staff can run.
    #[serde(default)]
    pub staff_only: f64,
    /// Checks that decide about the points.
    pub checks: Vec<CheckId>,
    /// The same checks in the order in which a student gets them to pass, by step; empty if the rubric names no steps.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub steps: Vec<Step>,
    /// How the points came about.
    pub state: TaskState,
}

/// A part of a task.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Step {
    /// Name of the step.
    pub title: String,
    /// Its checks.
    pub checks: Vec<CheckId>,
}

/// How the points of a task came about.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum TaskState {
    /// Each check that passed earned its share.
    Graded {
        /// Checks that did not pass.
        missing: Vec<CheckId>,
    },
    /// This required check did not pass, which costs all points; `None` if students may not see the check.
    RequiredCheckMissing(Option<CheckId>),
    /// A required check of this other task did not pass.
    RequiredTaskMissing(String),
    /// The submission does not compile.
    NotCompiled,
    /// The submission was refused: there was nothing to grade.
    NothingToGrade,
    /// Not all of its checks were selected (`--only`).
    Partial,
    /// A tutor grades it.
    ByHand {
        /// The tutor's comment; `None` until the task is graded.
        comment: Option<String>,
    },
}

/// A check that does not apply to a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SkippedCheck {
    /// Kind of check.
    pub kind: CheckKind,
    /// Technique.
    #[schemars(with = "crate::schema::TechniqueName")]
    pub technique: Technique,
    /// Name of the scene.
    pub scene: String,
    /// The check of the rubric that was skipped; `None` if the rubric has no such check.
    pub check: Option<CheckId>,
    /// Reason why the check does not apply to this scene.
    pub why: WhyNot,
}

impl SkippedCheck {
    /// Who may see it.
    pub fn visibility(&self) -> Visibility {
        Visibility::of(self.kind, &self.scene)
    }
}

/// A likely cause of the failed checks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Diagnosis {
    /// The cause.
    pub cause: Cause,
    /// Posterior probability among all known mistakes, in [0, 1].
    pub confidence: f64,
    /// Checks that are evidence for the cause; `None` if the cause needs no evidence.
    pub seen: Option<SeenIn>,
}

/// A cause of failed checks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Cause {
    /// A known mistake, in the words of the assignment's `causes.yml`.
    Known {
        /// Identifier.
        id: String,
        /// Description in one sentence.
        title: String,
        /// Hint for the student.
        hint: String,
    },
    /// A fact of the audit that fails. It is true whatever the mistake is.
    FailedFact(Fact),
    /// No known mistake fits, or several do.
    Unknown {
        /// True if several fit.
        several_fit: bool,
    },
    /// There was nothing to compile.
    NothingToCompile,
    /// The file does not compile.
    DoesNotCompile,
    /// The program panics.
    Panics,
    /// The program reaches a `todo!` or `unimplemented!`.
    TodoLeft,
    /// The program exceeds its time limit.
    DoesNotFinish {
        /// Number of checks that exceeded the time limit.
        late: usize,
    },
    /// Light samples are wrong by the same factor in all of these scenes.
    ConstantFactor {
        /// Factor: above 1 if too bright.
        factor: f64,
        /// Names of the scenes.
        scenes: Vec<String>,
    },
    /// The submission is the untouched starting file.
    NotBegun {
        /// What to begin with; empty if the assignment does not say.
        hint: String,
    },
    /// The submission does not use a technique.
    TechniqueNotBegun {
        /// The technique.
        #[schemars(with = "crate::schema::TechniqueName")]
        technique: Technique,
        /// The name by which a source would use it.
        name: String,
        /// What to begin with; empty if the assignment does not say.
        hint: String,
    },
    /// The technique `bsdf` is no longer plain BSDF sampling.
    BsdfChanged,
}

impl Cause {
    /// Identifier used in tables.
    pub fn id(&self) -> &str {
        match self {
            Self::Known { id, .. } => id,
            Self::FailedFact(_) => "failed-fact",
            Self::Unknown { .. } => "unknown",
            Self::NothingToCompile => "nothing-to-compile",
            Self::DoesNotCompile => "does-not-compile",
            Self::Panics => "panics",
            Self::TodoLeft => "todo-left",
            Self::DoesNotFinish { .. } => "does-not-finish",
            Self::ConstantFactor { .. } => "constant-factor",
            Self::NotBegun { .. } => "not-begun",
            Self::TechniqueNotBegun { .. } => "technique-not-begun",
            Self::BsdfChanged => "bsdf-changed",
        }
    }
}

/// Checks that are evidence for a cause.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SeenIn {
    /// A check that fails the way the cause predicts.
    pub wrong: CheckId,
    /// A check that passes although other causes would make it fail.
    pub right: Option<CheckId>,
}

/// Wall time by phase, in seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Cost {
    /// Preparing the framework, the scenes and their references.
    pub framework: f64,
    /// Compiling the submission.
    pub build: f64,
    /// Running its checks.
    pub run: f64,
    /// All phases.
    pub total: f64,
}

/// Confinement of the submission.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Sandbox {
    /// Level that holds for both compiler and program.
    pub level: Level,
    /// Layers that confined rustc.
    pub compiler: Layers,
    /// Layers that confined the program. If the submission does not compile: the layers that this machine supports.
    pub host: Layers,
    /// What the source uses although the sandbox refuses it. It costs no points by itself.
    pub findings: Vec<SourceFinding>,
}

impl Sandbox {
    /// Combines the layers of compiler and program.
    pub fn new(compiler: Layers, host: Layers, findings: Vec<SourceFinding>) -> Self {
        Self { level: Level::of(compiler.and(host)), compiler, host, findings }
    }
}

/// Versions and seeds that the grade depends on.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Provenance {
    /// The assignment as given on the command line: a name or a folder.
    pub assignment: String,
    /// Version of the grader.
    pub grader: String,
    /// BLAKE3 of everything the framework is built from.
    pub framework: String,
    /// BLAKE3 of the rubric.
    pub rubric: String,
    /// BLAKE3 of the references.
    pub references: String,
    /// Seed of the grade; `None` in the student's edition if it is secret.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seed: Option<u64>,
    /// True if only staff know the seed.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub secret_seed: bool,
    /// Version of the compiler, as it reports it.
    pub toolchain: String,
    /// Number of threads of the submission.
    pub threads: usize,
}

impl Report {
    /// Checks of a task that cost it points: failed ones before inconclusive ones, and required ones first among each.
    pub fn lacking(&self, task: &str) -> Vec<&CheckResult> {
        let mut lacking: Vec<&CheckResult> =
            self.checks.iter().filter(|check| check.task == task && check.costs_points()).collect();
        lacking.sort_by_key(|check| (check.verdict == Verdict::Inconclusive, !check.required));
        lacking
    }

    /// Result of the check with this identity; `None` if it was not run.
    pub fn check(&self, id: &CheckId) -> Option<&CheckResult> {
        self.checks.iter().find(|check| check.id == *id)
    }

    /// Reads a report written by [`Self::save`].
    ///
    /// # Errors
    /// If it cannot be read or is not a report of version [`SCHEMA`].
    pub fn load(path: &Path) -> Result<Self> {
        #[derive(Deserialize)]
        struct Version {
            schema: String,
        }
        let bytes = std::fs::read(path).map_err(|error| Error::file(path, error))?;
        let refuse =
            |error: serde_json::Error| Error::file(path, format!("not a report of the grader: {error}"));
        let Version { schema } = serde_json::from_slice(&bytes).map_err(refuse)?;
        if schema != SCHEMA {
            return Err(Error::file(path, format!("a report of format {schema}, not {SCHEMA}: grade again")));
        }
        serde_json::from_slice(&bytes).map_err(refuse)
    }

    /// Writes the report as JSON.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn save(&self, path: &Path) -> Result<()> {
        output::write_json(path, self)
    }
}
