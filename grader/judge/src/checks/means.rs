//! Testing the means of a submission's pictures: requests samples, and turns the judgement into evidence.

use arty::integrator::Settings;
use arty::scene::SceneDescription;
use harness::host_process::HostProcess;
use host::protocol::{AnomalousSample, RenderJob, Switches};
use verdict::check::{Effect, Evidence, MeanTest, Numerics, Reason, Verdict};
use verdict::replay::ReplayTarget;
use verdict::rubric::CheckSpec;

use super::context::{anomaly, replay_of, settings_of, switches_of};
use super::{CheckOutcome, GradeContext, JobError};
use crate::reference::SIZE;
use crate::statistics::expected::Expected;
use crate::statistics::regions::{pyramid, weighted_image};
use crate::statistics::sequential::{Decision, Judgement, SampleRequest, SequentialTest, judge};

/// A picture whose mean is tested.
pub(super) struct Picture<'a> {
    /// Scenes to render. The picture is the sum of their renderings.
    pub(super) scenes: &'a [&'a SceneDescription],
    /// Expected mean and noise.
    pub(super) expected: &'a Expected,
    /// Settings of the submission's path tracer.
    pub(super) settings: Settings,
    /// Switches of the scenes.
    pub(super) switches: Switches,
    /// Relative error of the whole image's mean that a pass excludes.
    pub(super) tolerance: f64,
    /// Screening level of this picture.
    pub(super) screening_level: f64,
    /// Maximum number of looks.
    pub(super) looks: usize,
    /// Seed of all samples.
    pub(super) seed: u64,
}

impl<'a> Picture<'a> {
    /// The picture of a check with its settings.
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

    /// Tests the mean in a new process of the submission.
    pub(super) fn judge(
        &self,
        context: &GradeContext<'_>,
        anomalies: &mut Anomalies,
    ) -> Result<Judgement, JobError> {
        let mut process = context.start()?;
        let scenes = self
            .scenes
            .iter()
            .map(|scene| process.load_with(scene, self.switches))
            .collect::<Result<Vec<u32>, JobError>>()?;
        self.judge_in(&mut process, &scenes, anomalies)
    }

    /// Tests the mean in a process that has already loaded the scenes.
    pub(super) fn judge_in(
        &self,
        process: &mut HostProcess,
        scenes: &[u32],
        anomalies: &mut Anomalies,
    ) -> Result<Judgement, JobError> {
        let mut regions = pyramid(SIZE.0, SIZE.1);
        regions.push(weighted_image(self.expected));
        let test = SequentialTest {
            expected: self.expected,
            regions: &regions,
            decisive: regions.len() - 1,
            tolerance: self.tolerance,
            screening_level: self.screening_level,
            seed: self.seed,
            looks: self.looks,
        };
        judge(&test, |request| {
            let mut sum: Vec<Vec<[f32; 3]>> = Vec::new();
            for (part, &scene) in scenes.iter().enumerate() {
                let batches = self.render(process, scene, part as u64, request, anomalies)?;
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
        request: &SampleRequest,
        anomalies: &mut Anomalies,
    ) -> Result<Vec<Vec<[f32; 3]>>, JobError> {
        // The parts of a sum must have independent random numbers.
        let seeds: Vec<u64> = request.seeds.iter().map(|seed| seed ^ part.rotate_right(8)).collect();
        let per_batch = request.samples * u64::from(SIZE.0 * SIZE.1);
        let per_job = usize::try_from(SAMPLES_PER_JOB / per_batch.max(1)).unwrap_or(usize::MAX).max(1);
        let mut batches = Vec::with_capacity(seeds.len());
        for seeds in seeds.chunks(per_job) {
            let job = RenderJob {
                first_sample: request.first_sample,
                ..RenderJob::new(scene, self.settings, [SIZE.0, SIZE.1], seeds.to_vec(), request.samples)
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

/// Maximum number of samples per job, so that the time limit of a job does not depend on the number of samples
/// requested.
const SAMPLES_PER_JOB: u64 = 1 << 20;

/// Samples that are not radiance, accumulated over jobs.
#[derive(Default)]
pub(super) struct Anomalies {
    /// Number of samples that are NaN or infinite.
    non_finite: u64,
    /// Number of samples that are finite but negative.
    negative: u64,
    /// The first such samples of each job.
    first: Vec<AnomalousSample>,
}

impl Anomalies {
    /// The same in the form of the report. `path` is the replay target of the picture, if its scene has a name.
    pub(super) fn numerics(&self, path: Option<ReplayTarget>) -> Numerics {
        Numerics {
            non_finite: self.non_finite,
            negative: self.negative,
            first: self.first.first().map(|sample| anomaly(sample, path)),
        }
    }
}

/// Runs a check that tests the mean of one picture.
pub(super) fn run(
    context: &GradeContext<'_>,
    spec: &CheckSpec,
    picture: &Picture<'_>,
    evidence: impl FnOnce(MeanTest) -> Evidence,
) -> Result<CheckOutcome, JobError> {
    let mut anomalies = Anomalies::default();
    let judgement = picture.judge(context, &mut anomalies)?;
    let outcome = conclude(&judgement, evidence(mean_test(&judgement, picture.tolerance)), judgement.samples);
    Ok(outcome.with(anomalies.numerics(Some(replay_of(spec)))))
}

/// The outcome of a check that one judgement decides.
pub(super) fn conclude(judgement: &Judgement, evidence: Evidence, samples: u64) -> CheckOutcome {
    match judgement.decision {
        Decision::Biased => CheckOutcome::new(Reason::Bias, evidence, samples),
        Decision::Unbiased => CheckOutcome::new(Reason::None, evidence, samples),
        Decision::Unclear => CheckOutcome {
            verdict: Verdict::Inconclusive,
            ..CheckOutcome::new(Reason::Noise, evidence, samples)
        },
    }
}

/// Confidence of the reported intervals.
const CONFIDENCE: f64 = 0.99;

/// The measurements of a judgement. Infinite values, as for light in a picture that should be black, become `None`.
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
