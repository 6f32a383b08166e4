//! The context that all checks of a grade share.

use std::collections::BTreeMap;
use std::time::Instant;

use arty::integrator::Settings;
use arty::scene::{Scene, SceneDescription};
use harness::build::SubmissionProgram;
use harness::host_process::HostProcess;
use harness::workspace::Workspace;
use host::protocol::{AnomalousSample, Switches};
use verdict::check::{Anomaly, CheckResult, Fault, NotRun, Numerics, Reason, SkipReason, Verdict};
use verdict::error::Result;
use verdict::replay::ReplayTarget;
use verdict::rubric::{CheckSpec, EmissionOnHit, Task};

use harness::job::JobError;

use super::{CheckOutcome, of_kind};
use crate::audit::AuditOnce;
use crate::reference::{Oracle, Reference, SIZE};

/// Number of looks of a check that cannot affect the points any more: a large error shows at the first look, and most
/// correct submissions pass at the second.
const SHORT_LOOKS: usize = 2;

/// A scene with its reference.
pub struct SceneWithReference {
    /// Content of the scene.
    pub description: SceneDescription,
    /// The scene built for ray tracing.
    pub scene: Scene,
    /// Reference of the scene.
    pub reference: Reference,
}

/// The context that all checks of a grade share.
#[derive(Clone)]
pub struct GradeContext<'a> {
    /// Program of the submission.
    pub program: &'a SubmissionProgram,
    /// The solution; `None` if the checkout does not have it.
    pub oracle: Option<&'a Oracle>,
    /// The scenes, by name.
    pub scenes: &'a BTreeMap<String, SceneWithReference>,
    /// Facts about the submission.
    pub(crate) audit: &'a AuditOnce<'a>,
    /// Seed of the grade.
    pub seed: u64,
    /// Screening level of one check.
    pub screening_level: f64,
    /// Maximum number of looks per picture.
    pub looks: usize,
    /// Number of threads of the submission.
    pub threads: usize,
    /// The checkout.
    pub workspace: &'a Workspace,
}

impl GradeContext<'_> {
    /// Runs one check.
    ///
    /// # Errors
    /// If the grader itself fails. Faults of the submission are part of the result.
    pub fn run(&self, task: &Task, spec: &CheckSpec) -> Result<CheckResult> {
        let start = Instant::now();
        let begun = begin(task, spec, Verdict::Fail, Reason::None);
        let mut result = match of_kind(spec.check).run(self, spec) {
            Ok(CheckOutcome { verdict, reason, evidence, numerics, samples }) => {
                CheckResult { verdict, reason, evidence: Some(evidence), numerics, samples, ..begun }
            }
            Err(JobError::Submission(fault)) => {
                CheckResult { reason: reason_of(&fault), fault: Some(fault), ..begun }
            }
            Err(JobError::Harness(error)) => return Err(error),
        };
        result.seconds = start.elapsed().as_secs_f64();
        Ok(result)
    }

    /// The same context for checks that cannot affect the points any more: with the minimum number of looks for a pass.
    #[must_use]
    pub fn with_short_looks(&self) -> Self {
        Self { looks: SHORT_LOOKS, ..self.clone() }
    }

    /// Starts a process of the submission. Its time limit for the whole check is that of one job.
    pub(super) fn start(&self) -> Result<HostProcess> {
        Ok(HostProcess::start(self.program, self.threads)?.within(self.program.limits.job_time))
    }

    /// The scene that a check names.
    pub(super) fn scene(&self, spec: &CheckSpec) -> &SceneWithReference {
        &self.scenes[&spec.scene]
    }

    /// Seed of a check: a hash of the grade's seed and the check's identity, independent of other checks.
    pub(super) fn seed_of(&self, spec: &CheckSpec) -> u64 {
        let mut hasher = blake3::Hasher::new();
        hasher.update(&self.seed.to_le_bytes());
        hasher.update(spec.id().to_string().as_bytes());
        let mut first = [0; 8];
        first.copy_from_slice(&hasher.finalize().as_bytes()[..8]);
        u64::from_le_bytes(first)
    }
}

/// The result of a check that is skipped because the required check `lost_to` has already cost the points.
pub fn skipped(task: &Task, spec: &CheckSpec, lost_to: &verdict::check::CheckId) -> CheckResult {
    let why = SkipReason::PointsLostTo(Some(lost_to.clone()));
    begin(task, spec, Verdict::Skipped { why }, Reason::None)
}

/// The result of a check that is not run because earlier checks exceeded their time limits.
pub fn out_of_time(task: &Task, spec: &CheckSpec) -> CheckResult {
    begin(task, spec, Verdict::NotRun { why: NotRun::OutOfTime }, Reason::Timeout)
}

/// A result without measurements.
fn begin(task: &Task, spec: &CheckSpec, verdict: Verdict, reason: Reason) -> CheckResult {
    CheckResult {
        id: spec.id(),
        task: task.id.clone(),
        required: spec.required,
        visibility: spec.visibility(),
        verdict,
        reason,
        fault: None,
        evidence: None,
        numerics: Numerics::default(),
        short_look: false,
        samples: 0,
        seconds: 0.0,
    }
}

fn reason_of(fault: &Fault) -> Reason {
    match fault {
        Fault::Timeout(_) | Fault::TooSlow(_) | Fault::Waiting(_) => Reason::Timeout,
        Fault::Panic(_) | Fault::Crash(_) => Reason::Crash,
        Fault::TooManyRays { .. } => Reason::RayBudget,
        Fault::TooFewRays | Fault::Threads | Fault::Malformed(_) => Reason::Violation,
    }
}

/// Settings of the path tracer for a check.
pub(super) fn settings_of(spec: &CheckSpec) -> Settings {
    Settings { technique: spec.technique, max_bounces: spec.max_bounces }
}

/// Switches of the scene for a check.
pub(super) fn switches_of(spec: &CheckSpec) -> Switches {
    Switches { emission_on_hit: spec.emission_on_hit == EmissionOnHit::On }
}

/// Replay target of a check's picture, without seed, pixel and sample.
pub(super) fn replay_of(spec: &CheckSpec) -> ReplayTarget {
    ReplayTarget {
        scene: spec.scene.clone(),
        scale: 1.0,
        emission: 1.0,
        technique: spec.technique,
        max_bounces: spec.max_bounces,
        emission_on_hit: spec.emission_on_hit,
        size: [SIZE.0, SIZE.1],
        seed: 0,
        pixel: [0, 0],
        sample: 0,
    }
}

/// A sample in the form of the report, with a replay target if `path` names the scene.
pub(super) fn anomaly(sample: &AnomalousSample, path: Option<ReplayTarget>) -> Anomaly {
    let AnomalousSample { seed, x, y, sample, value } = *sample;
    let replay = path.map(|path| ReplayTarget { seed, pixel: [x, y], sample, ..path });
    Anomaly { pixel: [x, y], sample, value: value.map(Into::into), replay }
}
