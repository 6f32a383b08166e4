//! Judging the means of what a hand-in renders: asking for samples, and saying what came out.

use arty::integrator::Settings;
use arty::scene::SceneDescription;
use host::protocol::{AnomalousSample, RenderJob, Switches};

use super::{Bench, Stop};
use crate::reference::SIZE;
use crate::statistics::bias::Expected;
use crate::statistics::regions::{Kind, pyramid, weighted_image};
use crate::statistics::sequential::{Decision, Demand, Judgement, Question, judge};
use harness::host_process::HostProcess;
use verdict::report::{CheckResult, Reason, Verdict};
use verdict::rubric::{CheckSpec, Hits};

/// A picture whose mean is judged.
pub(super) struct Picture<'a> {
    /// What is rendered. Of several scenes the sum.
    pub(super) scenes: &'a [&'a SceneDescription],
    /// What it should be.
    pub(super) expected: &'a Expected,
    /// What the hand-in's path tracer is made with.
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
        bench: &Bench<'_>,
        spec: &CheckSpec,
        scenes: &'a [&'a SceneDescription],
        expected: &'a Expected,
    ) -> Self {
        Self {
            scenes,
            expected,
            settings: Settings { technique: spec.technique, max_bounces: spec.max_bounces },
            switches: Switches { emission_on_hit: spec.hits == Hits::On },
            tolerance: spec.tolerance,
            screening_level: bench.screening_level,
            looks: bench.looks,
            seed: bench.seed_of(spec),
        }
    }

    /// Judges what the hand-in makes of it.
    pub(super) fn judge(&self, bench: &Bench<'_>, numerics: &mut Numerics) -> Result<Judgement, Stop> {
        let mut process = bench.start()?;
        let scenes =
            self.scenes.iter().map(|scene| Ok(process.load(scene)??)).collect::<Result<Vec<u32>, Stop>>()?;
        self.judge_in(&mut process, &scenes, numerics)
    }

    /// The same by a process that has the scenes already.
    pub(super) fn judge_in(
        &self,
        process: &mut HostProcess,
        scenes: &[u32],
        numerics: &mut Numerics,
    ) -> Result<Judgement, Stop> {
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
                let batches = self.render(process, scene, part as u64, demand, numerics)?;
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
        numerics: &mut Numerics,
    ) -> Result<Vec<Vec<[f32; 3]>>, Stop> {
        // Parts of a sum must not share their random numbers.
        let seeds: Vec<u64> = demand.seeds.iter().map(|seed| seed ^ part.rotate_right(8)).collect();
        let per_batch = demand.samples * u64::from(SIZE.0 * SIZE.1);
        let per_job = usize::try_from(SAMPLES_PER_JOB / per_batch.max(1)).unwrap_or(usize::MAX).max(1);
        let mut batches = Vec::with_capacity(seeds.len());
        for seeds in seeds.chunks(per_job) {
            let job = RenderJob {
                scene,
                settings: self.settings,
                width: SIZE.0,
                height: SIZE.1,
                seeds: seeds.to_vec(),
                first_sample: demand.first_sample,
                samples: demand.samples,
                switches: self.switches,
            };
            let rendered = process.render(&job)??;
            numerics.non_finite += rendered.non_finite;
            numerics.negative += rendered.negative;
            numerics.first.extend(rendered.first_anomalies);
            batches.extend(rendered.batches);
        }
        Ok(batches)
    }
}

/// Samples that one job asks for at most, so that a job's time limit is never a matter of how many were wanted.
const SAMPLES_PER_JOB: u64 = 1 << 20;

/// Samples that are no radiance.
#[derive(Default)]
pub(super) struct Numerics {
    /// NaN or infinite.
    pub(super) non_finite: u64,
    /// Finite, but negative.
    pub(super) negative: u64,
    /// The first of each job.
    pub(super) first: Vec<AnomalousSample>,
}

impl Numerics {
    /// Puts them into a check's result: a hand-in that gives any has failed it. `again` gives the command that follows
    /// such a sample again, where there is one.
    pub(super) fn enter(
        &self,
        result: &mut CheckResult,
        again: impl FnOnce(&AnomalousSample) -> Option<String>,
    ) {
        result.non_finite += self.non_finite;
        result.negative += self.negative;
        if let Some(first) = self.first.first() {
            result.verdict = Verdict::Fail;
            result.reason = Reason::Numerics;
            result.explanation = format!(
                "{} samples are NaN or infinite and {} negative; the first: pixel ({}, {}), sample {}, value {:?}",
                self.non_finite, self.negative, first.x, first.y, first.sample, first.value
            );
            if let Some(command) = again(first) {
                result.explanation += &format!("; see it again with `{command}`");
            }
        }
    }
}

/// Judges one picture of a check's scene and says in the result what came out.
pub(super) fn run(
    bench: &Bench<'_>,
    spec: &CheckSpec,
    picture: &Picture<'_>,
    result: &mut CheckResult,
) -> Result<(), Stop> {
    let mut numerics = Numerics::default();
    let judgement = picture.judge(bench, &mut numerics);
    if let Ok(judgement) = &judgement {
        describe(result, judgement, picture.tolerance);
    }
    numerics.enter(result, |sample| Some(bench.replay(spec, sample)));
    judgement.map(|_| ())
}

/// Confidence of the interval that is reported.
const CONFIDENCE: f64 = 0.99;

/// Says in the result what was decided.
pub(super) fn describe(result: &mut CheckResult, judgement: &Judgement, tolerance: f64) {
    let comparison = judgement.comparison;
    let effect = comparison.relative();
    let margin = comparison.relative_margin(CONFIDENCE);
    // Light where all should be black is infinitely wrong, which JSON has no number for.
    result.effect = Some(effect).filter(|effect| effect.is_finite());
    result.interval = Some([effect - margin, effect + margin])
        .filter(|interval| interval.iter().all(|end| end.is_finite()));
    result.detectable = Some(judgement.detectable).filter(|effect| effect.is_finite());
    result.samples += judgement.samples;
    result.z = judgement.z.clone();
    result.enter_whole(judgement.whole.relative(), judgement.whole.relative_margin(0.99));
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
                100.0 * tolerance
            ),
        ),
        Decision::Unclear => (
            Verdict::Inconclusive,
            Reason::Noise,
            format!(
                "too noisy: after {} samples an error of {:.1} % could still hide, {:.1} % is allowed",
                judgement.samples,
                100.0 * judgement.detectable,
                100.0 * tolerance
            ),
        ),
    };
}

/// What a weighted sum over all tiles says, whose parts have either sign.
fn describe_pattern(effect: f64) -> String {
    format!("the means are {:.1} % off, too bright here and too dark there", 100.0 * effect.abs())
}

/// "12 % too dark", "2.1 times as bright as it should be", "black".
pub(super) fn describe_effect(effect: f64) -> String {
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
