//! The measurement of one curve: the renderings that are planned and done.

use arty::integrator::Settings;
use arty::sampler::batch_seed;
use host::protocol::RenderJob;

use super::estimate::Renders;
use crate::reference::SIZE;
use harness::host_process::HostProcess;
use harness::job::apart;
use verdict::check::Fault;
use verdict::error::Result;

/// A curve that is being measured: one program with one technique in one scene.
pub(super) struct CurveRun {
    /// Index of the program.
    pub(super) program: usize,
    pub(super) settings: Settings,
    pub(super) seed: u64,
    pub(super) levels: Vec<RenderLength>,
    pub(super) non_finite: u64,
    /// The fault that ended the measurement, if any.
    pub(super) fault: Option<Fault>,
}

/// Renderings of one length.
#[derive(Default)]
pub(super) struct RenderLength {
    wanted: usize,
    renders: Renders,
    /// Processor time of one rendering in seconds, for each job.
    times: Vec<f64>,
}

/// Number of rounds that the renderings of each length are divided into.
pub(super) const ROUNDS: usize = 3;

/// Number of renderings of the greatest length, and maximum of any length.
const RENDERS: (usize, usize) = (6, 48);

/// Ratio of the number of renderings of a length to that of the next longer one.
const SHORTER_FACTOR: f64 = 1.5;

/// Approximate minimum and maximum processor time of one rendering, in seconds.
const RENDER_TIME: (f64, f64) = (0.3e-3, 5.0);

/// Maximum ratio of a length to the next shorter one.
const MAX_STEP: f64 = 4.0;

impl CurveRun {
    /// Warms up, measures the speed, and plans renderings that take the given processor time in total.
    pub(super) fn plan(&mut self, process: &mut HostProcess, seconds: f64, lengths: u32) -> Result<()> {
        let mut samples = 1;
        let per_sample = loop {
            // These renderings are discarded.
            let Some((_, time)) = self.job(process, samples, &[batch_seed(self.seed, u64::MAX)])? else {
                return Ok(());
            };
            if time > (0.03 * seconds).min(0.02) || samples >= 1 << 20 {
                break time / samples as f64;
            }
            samples *= 2;
        };
        let last = f64::from(lengths.max(2) - 1);
        let shortest = (RENDER_TIME.0 / per_sample).max(1.0);
        let plan = |longest: f64| -> Vec<RenderLength> {
            let step = (longest / shortest).powf(1.0 / last).clamp(1.0, MAX_STEP);
            let level = |k: u32| {
                let samples = (longest / step.powf(last - f64::from(k))).round().max(1.0) as u64;
                let more = SHORTER_FACTOR.powi((lengths - 1 - k) as i32);
                let wanted = ((RENDERS.0 as f64 * more) as usize).min(RENDERS.1);
                RenderLength { wanted, renders: Renders { samples, ..Renders::default() }, times: Vec::new() }
            };
            let mut levels: Vec<RenderLength> = (0..lengths).map(level).collect();
            levels.dedup_by_key(|level| level.renders.samples);
            levels
        };
        let seconds_of = |levels: &[RenderLength]| -> f64 {
            levels.iter().map(|level| level.wanted as f64 * level.renders.samples as f64 * per_sample).sum()
        };
        let mut longest = (seconds / RENDERS.0 as f64).min(RENDER_TIME.1) / per_sample;
        while longest > 1.0 && seconds_of(&plan(longest)) > seconds {
            longest *= 0.95;
        }
        self.levels = plan(longest.max(1.0));
        Ok(())
    }

    /// Renders one round of one length.
    pub(super) fn render(&mut self, process: &mut HostProcess, level: usize, round: usize) -> Result<()> {
        let Some(RenderLength { wanted, renders, .. }) = self.levels.get(level) else { return Ok(()) };
        let (samples, first) = (renders.samples, renders.images.len());
        let until = wanted * (round + 1) / ROUNDS;
        let seeds: Vec<u64> = (first..until)
            .map(|index| batch_seed(batch_seed(self.seed, level as u64), index as u64))
            .collect();
        if seeds.is_empty() {
            return Ok(());
        }
        if let Some((images, seconds)) = self.job(process, samples, &seeds)? {
            self.levels[level].renders.images.extend(images);
            self.levels[level].times.push(seconds / seeds.len() as f64);
        }
        Ok(())
    }

    /// Renders images and measures their total processor time; `None` if the program has failed.
    fn job(&mut self, process: &mut HostProcess, samples: u64, seeds: &[u64]) -> Result<Option<Rendered>> {
        if self.fault.is_some() {
            return Ok(None);
        }
        let job = RenderJob::new(0, self.settings, [SIZE.0, SIZE.1], seeds.to_vec(), samples);
        match apart(process.render(&job))? {
            Ok(rendered) => {
                self.non_finite += rendered.non_finite;
                let pixels =
                    |batch: Vec<[f32; 3]>| batch.into_iter().map(|pixel| pixel.map(f64::from)).collect();
                let images = rendered.batches.into_iter().map(pixels).collect();
                // A coarse clock must not yield a time of 0.
                Ok(Some((images, rendered.cpu_seconds.max(1e-9))))
            }
            Err(fault) => {
                self.fault = Some(fault);
                Ok(None)
            }
        }
    }

    /// The renderings, shortest length first.
    pub(super) fn finish(&mut self) -> Vec<Renders> {
        let levels = std::mem::take(&mut self.levels).into_iter();
        let renders = levels.map(|mut level| {
            // The median over the jobs ignores those that other load on the machine has delayed.
            level.times.sort_unstable_by(f64::total_cmp);
            level.renders.seconds = level.times.get(level.times.len() / 2).copied().unwrap_or(0.0);
            level.renders
        });
        renders.collect()
    }
}

type Rendered = (Vec<Vec<[f64; 3]>>, f64);
