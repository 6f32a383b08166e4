//! What is looked at: one file a check.

mod closed_form;
mod efficiency;
mod hidden_variants;
mod light_pick;
mod mean_bias;
mod means;
mod metamorphic;
mod mis_weights;
mod randomness;
mod ray_budget;
mod stability;
#[cfg(test)]
mod test_scenes;
mod white_furnace;

pub use closed_form::why_no_closed_form;
pub use efficiency::why_it_does_not_tell;
pub use mean_bias::expected as expected_by_reference;
pub use white_furnace::why_no_furnace;

use std::collections::BTreeMap;
use std::time::Instant;

use arty::scene::{Scene, SceneDescription};
use host::protocol::{AnomalousSample, Switches};

use crate::reference::{Oracle, Reference, SIZE};
use crate::replay::Place;
use harness::build::HandInProgram;
use harness::host_process::{Fault, HostProcess};
use harness::workspace::Workspace;
use verdict::error::Result;
use verdict::report::{CheckResult, Reason, Verdict};
use verdict::rubric::{CheckKind, CheckSpec, Hits, Task};

/// Looks at what nothing depends on any more: a large error shows in the first, and most of what is right passes in
/// the second.
const GLANCE: usize = 2;

/// A scene with all that checks need to know of it.
pub struct JudgedScene {
    /// Its content.
    pub description: SceneDescription,
    /// The same, ready for rays; for its features.
    pub scene: Scene,
    /// What it looks like.
    pub reference: Reference,
}

/// What all checks of a grade share.
#[derive(Clone)]
pub struct Bench<'a> {
    /// The hand-in.
    pub program: &'a HandInProgram,
    /// The solution; none where the repository does not have it.
    pub oracle: Option<&'a Oracle>,
    /// The scenes by name.
    pub scenes: &'a BTreeMap<String, JudgedScene>,
    /// The seed of the grade.
    pub seed: u64,
    /// The share of the screening level that one check may spend.
    pub screening_level: f64,
    /// How many of the looks that a picture is worth are taken at most.
    pub looks: usize,
    /// Threads for the hand-in.
    pub threads: usize,
    /// The checkout.
    pub workspace: &'a Workspace,
    /// The hand-in's path, quoted for a shell.
    pub path: String,
    /// The command that repeats this grade, to which `--only=…` is added.
    pub command: String,
}

impl Bench<'_> {
    /// Runs one check.
    ///
    /// # Errors
    /// What is not the hand-in's doing. All else is in the result.
    pub fn run(&self, task: &Task, spec: &CheckSpec) -> Result<CheckResult> {
        let start = Instant::now();
        let mut result = self.begin(task, spec);
        let check = match spec.check {
            CheckKind::ClosedForm => closed_form::run,
            CheckKind::Efficiency => efficiency::run,
            CheckKind::HiddenVariants => hidden_variants::run,
            CheckKind::LightPick => light_pick::run,
            CheckKind::MeanBias => mean_bias::run,
            CheckKind::Metamorphic => metamorphic::run,
            CheckKind::MisWeights => mis_weights::run,
            CheckKind::Randomness => randomness::run,
            CheckKind::RayBudget => ray_budget::run,
            CheckKind::Stability => stability::run,
            CheckKind::WhiteFurnace => white_furnace::run,
        };
        match check(self, spec, &mut result) {
            Ok(()) => {}
            Err(Stop::HandIn(fault)) => blame(&mut result, fault),
            Err(Stop::Harness(error)) => return Err(error),
        }
        result.seconds = start.elapsed().as_secs_f64();
        Ok(result)
    }

    /// The same for checks on which nothing depends any more: only as many looks as a pass takes at least.
    pub fn at_a_glance(&self) -> Self {
        Self { looks: GLANCE, ..self.clone() }
    }

    /// The hand-in, started anew. For a whole check it has no more time than for a job.
    fn start(&self) -> Result<HostProcess> {
        Ok(HostProcess::start(self.program, self.threads)?.within(self.program.limits.job_time))
    }

    /// The scene that a check names.
    fn scene(&self, spec: &CheckSpec) -> &JudgedScene {
        &self.scenes[&spec.scene]
    }

    /// The result of a check that is not run, since it could change nothing: the points are lost to another.
    pub fn leave_out(&self, task: &Task, spec: &CheckSpec, cause: &str) -> CheckResult {
        let mut result = self.begin(task, spec);
        result.verdict = Verdict::LeftOut;
        result.reason = Reason::None;
        result.explanation = format!("not run, since the points are lost to {cause}");
        result
    }

    /// The result of a check that is not run, since the hand-in has already used up its time in others.
    pub fn give_up(&self, task: &Task, spec: &CheckSpec) -> CheckResult {
        let mut result = self.begin(task, spec);
        result.verdict = Verdict::Fail;
        result.reason = Reason::Timeout;
        result.explanation = "not run, because earlier checks did not finish in time".to_owned();
        result
    }

    /// The result of a check before anything is known.
    fn begin(&self, task: &Task, spec: &CheckSpec) -> CheckResult {
        CheckResult {
            id: spec.id(),
            check: spec.check,
            scene: spec.scene.clone(),
            task: task.id.clone(),
            technique: spec.technique,
            max_bounces: spec.max_bounces,
            evidence: spec.evidence,
            verdict: Verdict::Error,
            reason: Reason::Harness,
            explanation: String::new(),
            effect: None,
            interval: None,
            detectable: None,
            samples: 0,
            seconds: 0.0,
            non_finite: 0,
            negative: 0,
            weights: None,
            coefficients: Vec::new(),
            coefficient_margins: Vec::new(),
            variance_ratios: Vec::new(),
            details: BTreeMap::new(),
            remarks: Vec::new(),
            z: Vec::new(),
            repeat: format!("{} --only={}", self.command, spec.id()),
        }
    }

    /// The command that follows a sample of a check's picture again.
    fn replay(&self, spec: &CheckSpec, sample: &AnomalousSample) -> String {
        let place = Place {
            scene: spec.scene.clone(),
            description: self.scene(spec).description.clone(),
            scale: 1.0,
            emission: 1.0,
            technique: spec.technique,
            max_bounces: spec.max_bounces,
            size: [SIZE.0, SIZE.1],
            seed: 0,
            pixel: [0, 0],
            sample: 0,
            switches: Switches { emission_on_hit: spec.hits == Hits::On },
        };
        place.of(sample).command(&self.path)
    }

    /// The seed of a check: fixed by the grade's seed and the check's name, whatever else is run.
    fn seed_of(&self, spec: &CheckSpec) -> u64 {
        let mut hasher = blake3::Hasher::new();
        hasher.update(&self.seed.to_le_bytes());
        hasher.update(spec.id().as_bytes());
        let mut first = [0; 8];
        first.copy_from_slice(&hasher.finalize().as_bytes()[..8]);
        u64::from_le_bytes(first)
    }
}

/// The hand-in did not answer as it should.
fn blame(result: &mut CheckResult, fault: Fault) {
    result.verdict = Verdict::Fail;
    result.explanation = fault.to_string();
    result.reason = match fault {
        Fault::Timeout(_) | Fault::TooSlow(_) => Reason::Timeout,
        Fault::Panic(_) | Fault::Crash(_) => Reason::Crash,
        Fault::Malformed(_) => Reason::Violation,
    };
}

/// Why a check could not be finished.
enum Stop {
    /// The hand-in did not answer as it should.
    HandIn(Fault),
    /// Something else is wrong.
    Harness(verdict::error::Error),
}

impl From<Fault> for Stop {
    fn from(fault: Fault) -> Self {
        Self::HandIn(fault)
    }
}

impl From<verdict::error::Error> for Stop {
    fn from(error: verdict::error::Error) -> Self {
        Self::Harness(error)
    }
}
