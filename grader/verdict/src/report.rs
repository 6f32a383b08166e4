//! One grade of one submission. `report.json` holds all of it; every other format is made from that.

use std::path::Path;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::check::{CheckId, CheckKind, CheckResult, Numerics, Verdict, Visibility, WhyNot};
use crate::convergence::Convergence;
use crate::error::{Error, Result};
use crate::output;
use crate::pictures::ImageError;
use crate::sandbox::{Layers, Level};
use crate::submission::{BuildFailure, Explanation, IntakeFinding, SourceFinding};
use arty::integrator::Technique;

/// Version of the format.
pub const SCHEMA: &str = "arty-report/2";

/// The result of grading one submission.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Report {
    /// [`SCHEMA`].
    pub schema: String,
    /// What was graded.
    pub submission: SubmissionInfo,
    /// Name of the assignment.
    pub assignment: String,
    /// Sums of points.
    pub points: Points,
    /// Points task by task.
    pub tasks: Vec<TaskResult>,
    /// Checks that were planned for this submission.
    pub checks: Vec<CheckResult>,
    /// Checks that mean nothing in their scenes, whatever the submission.
    pub skipped: Vec<SkippedCheck>,
    /// Likely causes, the likeliest first.
    pub diagnosis: Vec<Diagnosis>,
    /// Samples that are not radiance, over all checks.
    pub numerics: Numerics,
    /// Where the time went.
    pub cost: Cost,
    /// How the submission was confined.
    pub sandbox: Sandbox,
    /// What the grade rests on.
    pub provenance: Provenance,
    /// Error against run time, where it was measured: that begins when the points stand, and changes none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub convergence: Option<Convergence>,
    /// Errors of a few pictures against their references, where they were rendered. They change no points either.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub images: Vec<ImageError>,
}

/// What was graded.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SubmissionInfo {
    /// Its path as it was given.
    pub path: String,
    /// BLAKE3 of its source, in hexadecimal.
    pub hash: String,
    /// Why it does not compile, if it does not.
    pub build_failure: Option<BuildFailure>,
    /// Written explanations that came with it, for a tutor to grade.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub explanations: Vec<Explanation>,
    /// Why there was nothing to compile.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub refusal: Option<IntakeFinding>,
    /// What was odd when it was taken in. It costs no points.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<IntakeFinding>,
}

/// Sums of points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Points {
    /// Earned in the tasks that are graded automatically.
    pub earned: f64,
    /// What these tasks are worth.
    pub automatic_max: f64,
    /// What the tasks are worth that a tutor grades.
    pub manual_max: f64,
    /// Both together.
    pub max: f64,
    /// Given by a tutor so far; none if nothing has been graded by hand.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub manual: Option<f64>,
    /// Of `automatic_max`, what is decided by checks that only staff can run.
    #[serde(default)]
    pub staff_only: f64,
}

/// The points of one task.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TaskResult {
    /// Its number on the sheet.
    pub id: String,
    /// Its title.
    pub title: String,
    /// Points earned; none yet where a tutor grades, or where not all checks were run.
    pub points: Option<f64>,
    /// Points for all of it.
    pub max: f64,
    /// Of these, what is decided by checks that only staff can run.
    #[serde(default)]
    pub staff_only: f64,
    /// The checks that decide.
    pub checks: Vec<CheckId>,
    /// Where its points are.
    pub state: TaskState,
}

/// Where the points of a task are.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum TaskState {
    /// Each check earned its share, but for these.
    Graded {
        /// Checks that did not pass.
        missing: Vec<CheckId>,
    },
    /// A check did not pass that must pass for any points; none where students do not see it.
    RequiredCheckMissing(Option<CheckId>),
    /// This other task must have its required checks first.
    RequiredTaskMissing(String),
    /// The submission does not compile.
    NotCompiled,
    /// There was nothing that could be graded.
    NothingToGrade,
    /// Not all of its checks were run, as was asked for.
    Partial,
    /// A tutor grades it, with this comment once that is done.
    ByHand {
        /// What the student is told.
        comment: Option<String>,
    },
}

/// A check that means nothing in a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SkippedCheck {
    /// Kind of check.
    pub kind: CheckKind,
    /// Technique.
    #[schemars(with = "crate::schema::TechniqueName")]
    pub technique: Technique,
    /// The scene.
    pub scene: String,
    /// The check of the rubric that was skipped; none where the rubric does not ask for one.
    pub check: Option<CheckId>,
    /// Why.
    pub why: WhyNot,
}

impl SkippedCheck {
    /// Who may see it.
    pub fn visibility(&self) -> Visibility {
        Visibility::of(self.kind, &self.scene)
    }
}

/// A likely cause.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Diagnosis {
    /// What is probably wrong.
    pub cause: Cause,
    /// Probability among all known mistakes, in [0, 1].
    pub confidence: f64,
    /// The checks that decided, where the cause does not say it by itself.
    pub seen: Option<SeenIn>,
}

/// What is probably wrong.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Cause {
    /// A mistake that the assignment knows, in the words of its `causes.yml`.
    Known {
        /// Its name.
        id: String,
        /// What it is.
        title: String,
        /// What to think about.
        hint: String,
    },
    /// No mistake fits, or several do.
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
    /// It reaches a place that is marked as still to be done.
    TodoLeft,
    /// It does not finish in time.
    DoesNotFinish {
        /// Checks that were not done in time.
        late: usize,
    },
    /// Each light sample is the same factor too bright or too dark in all of these scenes.
    ConstantFactor {
        /// The factor.
        factor: f64,
        /// The scenes.
        scenes: Vec<String>,
    },
    /// It is the starting file.
    NotBegun,
    /// Nothing in it asks for MIS.
    MisNotBegun,
}

impl Cause {
    /// Its name in tables.
    pub fn id(&self) -> &str {
        match self {
            Self::Known { id, .. } => id,
            Self::Unknown { .. } => "unknown",
            Self::NothingToCompile => "nothing-to-compile",
            Self::DoesNotCompile => "does-not-compile",
            Self::Panics => "panics",
            Self::TodoLeft => "todo-left",
            Self::DoesNotFinish { .. } => "does-not-finish",
            Self::ConstantFactor { .. } => "constant-factor",
            Self::NotBegun => "not-begun",
            Self::MisNotBegun => "mis-not-begun",
        }
    }
}

/// Checks that speak for a cause.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SeenIn {
    /// One that is wrong as the cause would have it.
    pub wrong: CheckId,
    /// One that passes where other causes would not.
    pub right: Option<CheckId>,
}

/// Where the time went, in seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Cost {
    /// Preparing the framework, the scenes and their references.
    pub framework: f64,
    /// Compiling the submission.
    pub build: f64,
    /// Running its checks.
    pub run: f64,
    /// Everything.
    pub total: f64,
}

/// How the submission was confined.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Sandbox {
    /// What compiler and program have in common, in one word.
    pub level: Level,
    /// What held for rustc.
    pub compiler: Layers,
    /// What held for the program. For a submission that does not compile, what this machine has.
    pub host: Layers,
    /// What the source names that the sandbox refuses. It costs no points by itself.
    pub findings: Vec<SourceFinding>,
}

impl Sandbox {
    /// The level that these layers come to.
    pub fn new(compiler: Layers, host: Layers, findings: Vec<SourceFinding>) -> Self {
        Self { level: Level::of(compiler.and(host)), compiler, host, findings }
    }
}

/// What the grade rests on.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Provenance {
    /// The assignment as it was asked for: a name, or a folder.
    pub assignment: String,
    /// Version of the grader.
    pub grader: String,
    /// BLAKE3 of all that the framework is built from.
    pub framework: String,
    /// BLAKE3 of the rubric.
    pub rubric: String,
    /// BLAKE3 of the references.
    pub references: String,
    /// Seed of the grade.
    pub seed: u64,
    /// The compiler, as it names itself.
    pub toolchain: String,
    /// Threads of the submission.
    pub threads: usize,
}

impl Report {
    /// The checks that a task lacks: first what is known to be wrong, of that what must pass for any points, then what is
    /// only not known to be right.
    pub fn lacking(&self, task: &str) -> Vec<&CheckResult> {
        let mut lacking: Vec<&CheckResult> =
            self.checks.iter().filter(|check| check.task == task && check.is_lacking()).collect();
        lacking.sort_by_key(|check| (check.verdict == Verdict::Inconclusive, !check.required));
        lacking
    }

    /// The result of a check.
    pub fn check(&self, id: &CheckId) -> Option<&CheckResult> {
        self.checks.iter().find(|check| check.id == *id)
    }

    /// Reads what [`Self::save`] has written.
    ///
    /// # Errors
    /// If it is no report of this version.
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
