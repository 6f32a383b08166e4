//! What is looked at: one file a check.

mod mean_bias;
mod mis_weights;
mod stability;
mod white_furnace;

pub use mis_weights::Weights;
pub use white_furnace::is_furnace;

use std::collections::BTreeMap;
use std::time::Instant;

use arty::scene::{Scene, SceneDescription};
use host::protocol::{AnomalousSample, RenderJob, Switches};

use crate::build::HandInProgram;
use crate::error::Result;
use crate::host_process::{Fault, HostProcess};
use crate::reference::{Reference, SIZE};
use crate::replay::Place;
use crate::report::{CheckResult, Reason, Verdict};
use crate::rubric::{CheckKind, CheckSpec, Hits, Task};
use crate::statistics::bias::Expected;
use crate::statistics::regions::{Kind, pyramid, weighted_image};
use crate::statistics::sequential::{Decision, Demand, Judgement, Question, judge};
use crate::workspace::Workspace;

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
pub struct Bench<'a> {
    /// The hand-in.
    pub program: &'a HandInProgram,
    /// The scenes by name.
    pub scenes: &'a BTreeMap<String, JudgedScene>,
    /// The seed of the grade.
    pub seed: u64,
    /// The share of the screening level that one check may spend.
    pub screening_level: f64,
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
        let expected = match spec.check {
            CheckKind::MeanBias => mean_bias::expected(spec, &self.scenes[&spec.scene].reference)?,
            CheckKind::WhiteFurnace => white_furnace::expected(spec, &self.scenes[&spec.scene])?,
            CheckKind::MisWeights => return self.probe_weights(task, spec),
            CheckKind::Stability => return self.check_stability(task, spec),
        };
        self.compare_means(task, spec, &self.scenes[&spec.scene], &expected)
    }

    /// Judges the weights of the hand-in, one by one.
    fn probe_weights(&self, task: &Task, spec: &CheckSpec) -> Result<CheckResult> {
        let start = Instant::now();
        let mut process = HostProcess::start(self.program, self.threads)?;
        let mut result = self.begin(task, spec);
        match mis_weights::run(&mut process, spec, self.seed_of(spec))? {
            Ok(outcome) => {
                result.verdict = outcome.verdict;
                result.reason = outcome.reason;
                result.explanation = outcome.explanation;
                result.weights = outcome.weights;
                result.samples = outcome.samples;
            }
            Err(fault) => blame(&mut result, fault),
        }
        result.seconds = start.elapsed().as_secs_f64();
        Ok(result)
    }

    /// The result of a check that is not run, since the hand-in has already used up its time in another.
    pub fn skip(&self, task: &Task, spec: &CheckSpec) -> CheckResult {
        let mut result = self.begin(task, spec);
        result.verdict = Verdict::Fail;
        result.reason = Reason::Timeout;
        result.explanation = "not run, because an earlier check did not finish in time".to_owned();
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
            remarks: Vec::new(),
            repeat: format!("{} --only={}", self.command, spec.id()),
        }
    }

    /// Judges the means of the hand-in's renderings.
    fn compare_means(
        &self,
        task: &Task,
        spec: &CheckSpec,
        judged: &JudgedScene,
        expected: &Expected,
    ) -> Result<CheckResult> {
        let start = Instant::now();
        let mut regions = pyramid(SIZE.0, SIZE.1);
        regions.push(weighted_image(expected));
        let question = Question {
            expected,
            regions: &regions,
            decisive: regions.len() - 1,
            tolerance: spec.tolerance,
            screening_level: self.screening_level,
            seed: self.seed_of(spec),
        };
        let mut numerics = Numerics::default();
        let mut process = HostProcess::start(self.program, self.threads)?;
        let judgement = match process.load(&judged.description)? {
            Err(fault) => Err(Stop::HandIn(fault)),
            Ok(scene) => judge(&question, |demand| {
                let mut batches = Vec::with_capacity(demand.seeds.len());
                let per_job = batches_per_job(demand);
                for seeds in demand.seeds.chunks(per_job) {
                    let job = render_job(scene, spec, demand, seeds);
                    let rendered = process.render(&job).map_err(Stop::Harness)?.map_err(Stop::HandIn)?;
                    numerics.non_finite += rendered.non_finite;
                    numerics.negative += rendered.negative;
                    numerics.first.extend(rendered.first_anomalies);
                    batches.extend(rendered.batches);
                }
                Ok(batches)
            }),
        };
        let mut result = self.begin(task, spec);
        result.non_finite = numerics.non_finite;
        result.negative = numerics.negative;
        match judgement {
            Ok(judgement) => describe(&mut result, &judgement, spec),
            Err(Stop::HandIn(fault)) => blame(&mut result, fault),
            Err(Stop::Harness(error)) => return Err(error),
        }
        if let Some(first) = numerics.first.first() {
            result.verdict = Verdict::Fail;
            result.reason = Reason::Numerics;
            result.explanation = format!(
                "{} samples are NaN or infinite and {} negative; the first: pixel ({}, {}), sample {}, value {:?}; see it \
                 again with `{}`",
                numerics.non_finite,
                numerics.negative,
                first.x,
                first.y,
                first.sample,
                first.value,
                self.replay(spec, first)
            );
        }
        result.seconds = start.elapsed().as_secs_f64();
        Ok(result)
    }

    /// The command that follows a sample of a check's picture again.
    fn replay(&self, spec: &CheckSpec, sample: &AnomalousSample) -> String {
        let place = Place {
            scene: spec.scene.clone(),
            description: self.scenes[&spec.scene].description.clone(),
            scale: 1.0,
            emission: 1.0,
            technique: spec.technique,
            max_bounces: spec.max_bounces,
            size: [SIZE.0, SIZE.1],
            seed: 0,
            pixel: [0, 0],
            sample: 0,
            switches: Switches { hits_off: spec.hits == Hits::Off, ..Switches::default() },
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
        Fault::Timeout => Reason::Timeout,
        Fault::Panic(_) | Fault::Crash(_) => Reason::Crash,
        Fault::Malformed(_) => Reason::Violation,
    };
}

/// Why samples stopped coming.
enum Stop {
    HandIn(Fault),
    Harness(crate::error::Error),
}

/// Samples that are no radiance.
#[derive(Default)]
struct Numerics {
    non_finite: u64,
    negative: u64,
    first: Vec<AnomalousSample>,
}

/// Samples that one job asks for at most, so that a job's time limit is never a matter of how many were wanted.
const SAMPLES_PER_JOB: u64 = 1 << 20;

fn batches_per_job(demand: &Demand) -> usize {
    let per_batch = demand.samples * u64::from(SIZE.0 * SIZE.1);
    usize::try_from(SAMPLES_PER_JOB / per_batch.max(1)).unwrap_or(usize::MAX).max(1)
}

fn render_job(scene: u32, spec: &CheckSpec, demand: &Demand, seeds: &[u64]) -> RenderJob {
    RenderJob {
        scene,
        settings: arty::integrator::Settings { technique: spec.technique, max_bounces: spec.max_bounces },
        width: SIZE.0,
        height: SIZE.1,
        seeds: seeds.to_vec(),
        first_sample: demand.first_sample,
        samples: demand.samples,
        switches: Switches { hits_off: spec.hits == Hits::Off, ..Switches::default() },
    }
}

/// Confidence of the interval that is reported.
const CONFIDENCE: f64 = 0.99;

fn describe(result: &mut CheckResult, judgement: &Judgement, spec: &CheckSpec) {
    let comparison = judgement.comparison;
    let effect = comparison.relative();
    let margin = comparison.relative_margin(CONFIDENCE);
    // Light where all should be black is infinitely wrong, which JSON has no number for.
    result.effect = Some(effect).filter(|effect| effect.is_finite());
    result.interval = Some([effect - margin, effect + margin])
        .filter(|interval| interval.iter().all(|end| end.is_finite()));
    result.detectable = Some(judgement.detectable).filter(|effect| effect.is_finite());
    result.samples = judgement.samples;
    (result.verdict, result.reason, result.explanation) = match judgement.decision {
        Decision::Biased => (
            Verdict::Fail,
            Reason::Bias,
            format!(
                "{} ({}), confirmed with fresh random numbers",
                if judgement.kind == Kind::Pattern {
                    describe_pattern(effect)
                } else {
                    describe_effect(effect)
                },
                judgement.region
            ),
        ),
        Decision::Unbiased => (
            Verdict::Pass,
            Reason::None,
            format!(
                "the mean is right to within {:.2} % ({:.0} % allowed)",
                100.0 * (effect.abs() + margin),
                100.0 * spec.tolerance
            ),
        ),
        Decision::Unclear => (
            Verdict::Inconclusive,
            Reason::Noise,
            format!(
                "too noisy: after {} samples an error of {:.1} % could still hide, {:.1} % is allowed",
                judgement.samples,
                100.0 * judgement.detectable,
                100.0 * spec.tolerance
            ),
        ),
    };
}

/// What a weighted sum over all tiles says, whose parts have either sign.
fn describe_pattern(effect: f64) -> String {
    format!("the means are {:.1} % off, too bright here and too dark there", 100.0 * effect.abs())
}

/// "12 % too dark", "2.1 times as bright as it should be", "black".
fn describe_effect(effect: f64) -> String {
    if effect <= -1.0 {
        "the mean is black".to_owned()
    } else if effect < 0.0 {
        format!("the mean is {:.1} % too dark", -100.0 * effect)
    } else if effect < 0.5 {
        format!("the mean is {:.1} % too bright", 100.0 * effect)
    } else if effect.is_finite() {
        format!("the mean is {:.2} times as bright as it should be", 1.0 + effect)
    } else {
        "the mean is bright where it should be black".to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::describe_effect;

    #[test]
    fn effects_read_like_sentences() {
        assert_eq!(describe_effect(-1.0), "the mean is black");
        assert_eq!(describe_effect(-0.123), "the mean is 12.3 % too dark");
        assert_eq!(describe_effect(0.02), "the mean is 2.0 % too bright");
        assert_eq!(describe_effect(1.0), "the mean is 2.00 times as bright as it should be");
        assert_eq!(describe_effect(f64::INFINITY), "the mean is bright where it should be black");
    }
}
