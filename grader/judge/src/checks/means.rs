//! Judging the means of what a submission renders: asks for samples, and turns the judgement into evidence.

use arty::integrator::Settings;
use arty::scene::SceneDescription;
use harness::host_process::HostProcess;
use host::protocol::{AnomalousSample, RenderJob, Switches};
use verdict::check::{Effect, Evidence, MeanTest, Numerics, Reason, Verdict};
use verdict::replay::ReplayTarget;
use verdict::rubric::CheckSpec;

use super::context::{anomaly, replay_of, settings_of, switches_of};
use super::{GradeContext, JobError, Outcome};
use crate::reference::SIZE;
use crate::statistics::bias::Expected;
use crate::statistics::regions::{pyramid, weighted_image};
use crate::statistics::sequential::{Decision, Demand, Judgement, Question, judge};

/// A picture whose mean is judged.
pub(super) struct Picture<'a> {
    /// What is rendered. Of several scenes the sum.
    pub(super) scenes: &'a [&'a SceneDescription],
    /// What it should be.
    pub(super) expected: &'a Expected,
    /// What the submission's path tracer is made with.
    pub(super) settings: Settings,
    /// Which ways of finding light are closed.
    pub(super) switches: Switches,
    /// The relative error of the whole image's mean that a pass excludes.
    pub(super) tolerance: f64,
    /// The share of the screening level that this picture may spend.
    pub(super) screening_level: f64,
    /// How many looks are taken at most.
    pub(super) looks: usize,
    /// The seed of all samples.
    pub(super) seed: u64,
}

impl<'a> Picture<'a> {
    /// What a check asks for in one scene.
    pub(super) fn of(
        context: &GradeContext<'_>,
        spec: &CheckSpec,
        scenes: &'a [&'a SceneDescription],
        expected: &'a Expected,
    ) -> Self {
        Self {
            scenes,
            expected,
            settings: settings_of(spec),
            switches: switches_of(spec),
            tolerance: spec.tolerance,
            screening_level: context.screening_level,
            looks: context.looks,
            seed: context.seed_of(spec),
        }
    }

    /// Judges what the submission makes of it.
    pub(super) fn judge(
        &self,
        context: &GradeContext<'_>,
        anomalies: &mut Anomalies,
    ) -> Result<Judgement, JobError> {
        let mut process = context.start()?;
        let scenes =
            self.scenes.iter().map(|scene| process.load(scene)).collect::<Result<Vec<u32>, JobError>>()?;
        self.judge_in(&mut process, &scenes, anomalies)
    }

    /// The same by a process that has the scenes already.
    pub(super) fn judge_in(
        &self,
        process: &mut HostProcess,
        scenes: &[u32],
        anomalies: &mut Anomalies,
    ) -> Result<Judgement, JobError> {
        let mut regions = pyramid(SIZE.0, SIZE.1);
        regions.push(weighted_image(self.expected));
        let question = Question {
            expected: self.expected,
            regions: &regions,
            decisive: regions.len() - 1,
            tolerance: self.tolerance,
            screening_level: self.screening_level,
            seed: self.seed,
            looks: self.looks,
        };
        judge(&question, |demand| {
            let mut sum: Vec<Vec<[f32; 3]>> = Vec::new();
            for (part, &scene) in scenes.iter().enumerate() {
                let batches = self.render(process, scene, part as u64, demand, anomalies)?;
                if sum.is_empty() {
                    sum = batches;
                } else {
                    let pairs = sum.iter_mut().flatten().flatten().zip(batches.iter().flatten().flatten());
                    pairs.for_each(|(sum, value)| *sum += value);
                }
            }
            Ok(sum)
        })
    }

    fn render(
        &self,
        process: &mut HostProcess,
        scene: u32,
        part: u64,
        demand: &Demand,
        anomalies: &mut Anomalies,
    ) -> Result<Vec<Vec<[f32; 3]>>, JobError> {
        // Parts of a sum must not share their random numbers.
        let seeds: Vec<u64> = demand.seeds.iter().map(|seed| seed ^ part.rotate_right(8)).collect();
        let per_batch = demand.samples * u64::from(SIZE.0 * SIZE.1);
        let per_job = usize::try_from(SAMPLES_PER_JOB / per_batch.max(1)).unwrap_or(usize::MAX).max(1);
        let mut batches = Vec::with_capacity(seeds.len());
        for seeds in seeds.chunks(per_job) {
            let job = RenderJob {
                first_sample: demand.first_sample,
                switches: self.switches,
                ..RenderJob::new(scene, self.settings, [SIZE.0, SIZE.1], seeds.to_vec(), demand.samples)
            };
            let rendered = process.render(&job)?;
            anomalies.non_finite += rendered.non_finite;
            anomalies.negative += rendered.negative;
            anomalies.first.extend(rendered.first_anomalies);
            batches.extend(rendered.batches);
        }
        Ok(batches)
    }
}

/// Samples that one job asks for at most, so that a job's time limit is never a matter of how many were wanted.
const SAMPLES_PER_JOB: u64 = 1 << 20;

/// Samples that are not radiance, as they come in.
#[derive(Default)]
pub(super) struct Anomalies {
    /// NaN or infinite.
    non_finite: u64,
    /// Finite, but negative.
    negative: u64,
    /// The first of each job.
    first: Vec<AnomalousSample>,
}

impl Anomalies {
    /// The same as a report has them; `path` names the picture, where that can be rendered again.
    pub(super) fn numerics(&self, path: Option<ReplayTarget>) -> Numerics {
        Numerics {
            non_finite: self.non_finite,
            negative: self.negative,
            first: self.first.first().map(|sample| anomaly(sample, path)),
        }
    }
}

/// Judges one picture of a check's scene.
pub(super) fn run(
    context: &GradeContext<'_>,
    spec: &CheckSpec,
    picture: &Picture<'_>,
    evidence: impl FnOnce(MeanTest) -> Evidence,
) -> Result<Outcome, JobError> {
    let mut anomalies = Anomalies::default();
    let judgement = picture.judge(context, &mut anomalies)?;
    let outcome = conclude(&judgement, evidence(mean_test(&judgement, picture.tolerance)), judgement.samples);
    Ok(outcome.with(anomalies.numerics(Some(replay_of(spec)))))
}

/// The outcome that a judgement comes to.
pub(super) fn conclude(judgement: &Judgement, evidence: Evidence, samples: u64) -> Outcome {
    match judgement.decision {
        Decision::Biased => Outcome::new(Reason::Bias, evidence, samples),
        Decision::Unbiased => Outcome::new(Reason::None, evidence, samples),
        Decision::Unclear => {
            Outcome { verdict: Verdict::Inconclusive, ..Outcome::new(Reason::Noise, evidence, samples) }
        }
    }
}

/// Confidence of the intervals that are reported.
const CONFIDENCE: f64 = 0.99;

/// The measurements of a judgement. Light where all should be black is infinitely wrong, which is no number.
pub(super) fn mean_test(judgement: &Judgement, tolerance: f64) -> MeanTest {
    let effect = judgement.comparison.relative();
    let margin = judgement.comparison.relative_margin(CONFIDENCE);
    let whole =
        Effect { relative: judgement.whole.relative(), margin: judgement.whole.relative_margin(CONFIDENCE) };
    MeanTest {
        region: judgement.region,
        effect: Some(effect).filter(|effect| effect.is_finite()),
        interval: Some([effect - margin, effect + margin])
            .filter(|interval| interval.iter().all(|end| end.is_finite())),
        detectable: Some(judgement.detectable).filter(|effect| effect.is_finite()),
        tolerance,
        whole: Some(whole).filter(|whole| whole.relative.is_finite() && whole.margin.is_finite()),
        z: judgement.z.clone(),
    }
}
