//! What all checks of a grade share.

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

use super::{Outcome, of_kind};
use crate::reference::{Oracle, Reference, SIZE};

/// Looks at a check on which nothing depends any more: a large error shows in the first, and most of what is right passes
/// in the second.
const SHORT_LOOKS: usize = 2;

/// A scene with everything that checks need to know of it.
pub struct SceneWithReference {
    /// Its content.
    pub description: SceneDescription,
    /// The same, ready for rays; for its features.
    pub scene: Scene,
    /// Its picture.
    pub reference: Reference,
}

/// What all checks of a grade share.
#[derive(Clone)]
pub struct GradeContext<'a> {
    /// The submission.
    pub program: &'a SubmissionProgram,
    /// The solution; none where the checkout does not have it.
    pub oracle: Option<&'a Oracle>,
    /// The scenes by name.
    pub scenes: &'a BTreeMap<String, SceneWithReference>,
    /// Seed of the grade.
    pub seed: u64,
    /// Share of the screening level that one check may spend.
    pub screening_level: f64,
    /// Maximum number of looks at one picture.
    pub looks: usize,
    /// Threads of the submission.
    pub threads: usize,
    /// The checkout.
    pub workspace: &'a Workspace,
}

impl GradeContext<'_> {
    /// Runs one check.
    ///
    /// # Errors
    /// What is not the submission's doing. All else is in the result.
    pub fn run(&self, task: &Task, spec: &CheckSpec) -> Result<CheckResult> {
        let start = Instant::now();
        let begun = begin(task, spec, Verdict::Fail, Reason::None);
        let mut result = match of_kind(spec.check).run(self, spec) {
            Ok(Outcome { verdict, reason, evidence, numerics, samples }) => {
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

    /// The same for checks on which nothing depends any more: only as many looks as a pass takes at least.
    #[must_use]
    pub fn with_short_looks(&self) -> Self {
        Self { looks: SHORT_LOOKS, ..self.clone() }
    }

    /// The submission, started anew. For a whole check it has no more time than for a job.
    pub(super) fn start(&self) -> Result<HostProcess> {
        Ok(HostProcess::start(self.program, self.threads)?.within(self.program.limits.job_time))
    }

    /// The scene that a check names.
    pub(super) fn scene(&self, spec: &CheckSpec) -> &SceneWithReference {
        &self.scenes[&spec.scene]
    }

    /// Seed of a check: fixed by the grade's seed and the check's identity, whatever else is run.
    pub(super) fn seed_of(&self, spec: &CheckSpec) -> u64 {
        let mut hasher = blake3::Hasher::new();
        hasher.update(&self.seed.to_le_bytes());
        hasher.update(spec.id().to_string().as_bytes());
        let mut first = [0; 8];
        first.copy_from_slice(&hasher.finalize().as_bytes()[..8]);
        u64::from_le_bytes(first)
    }
}

/// The result of a check that is skipped, since the points are lost to another.
pub fn skip(task: &Task, spec: &CheckSpec, lost_to: &verdict::check::CheckId) -> CheckResult {
    let why = SkipReason::PointsLostTo(Some(lost_to.clone()));
    begin(task, spec, Verdict::Skipped { why }, Reason::None)
}

/// The result of a check that is not run, since the submission used up its time in others.
pub fn give_up(task: &Task, spec: &CheckSpec) -> CheckResult {
    begin(task, spec, Verdict::NotRun { why: NotRun::OutOfTime }, Reason::Timeout)
}

/// The result of a check before anything is known.
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
        Fault::Timeout(_) | Fault::TooSlow(_) => Reason::Timeout,
        Fault::Panic(_) | Fault::Crash(_) => Reason::Crash,
        Fault::Malformed(_) => Reason::Violation,
    }
}

/// What a check makes the path tracer with.
pub(super) fn settings_of(spec: &CheckSpec) -> Settings {
    Settings { technique: spec.technique, max_bounces: spec.max_bounces }
}

/// The ways of finding light that a check leaves open.
pub(super) fn switches_of(spec: &CheckSpec) -> Switches {
    Switches { emission_on_hit: spec.emission_on_hit == EmissionOnHit::On }
}

/// The path of a check's picture, but for its seed, pixel and sample.
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

/// A sample as a report has it, with the path that shows it where that can be named.
pub(super) fn anomaly(sample: &AnomalousSample, path: Option<ReplayTarget>) -> Anomaly {
    let AnomalousSample { seed, x, y, sample, value } = *sample;
    let replay = path.map(|path| ReplayTarget { seed, pixel: [x, y], sample, ..path });
    Anomaly { pixel: [x, y], sample, value: value.map(Into::into), replay }
}
