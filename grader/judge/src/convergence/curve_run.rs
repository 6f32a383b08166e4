//! The measurement of one curve: the renderings that are planned and done.

use arty::integrator::Settings;
use arty::sampler::batch_seed;
use host::protocol::{RenderJob, Rendered};

use super::bias::MeanProduct;
use super::plan::{PlannedLevel, levels};
use super::tally::{Block, Errors, Level, Tally};
use crate::image_error::{Truth, mse, relative_mse, trimmed_relative_mse};
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
    planned: Vec<PlannedLevel>,
    pub(super) tally: Tally,
    pub(super) bias_squared: MeanProduct,
    pub(super) non_finite: u64,
    /// Processor time of a sample per pixel in seconds, as first seen.
    pub(super) per_sample: f64,
    /// The fault that ended the measurement, if any.
    pub(super) fault: Option<Fault>,
}

/// Processor time of the last warm-up rendering, in seconds.
const WARM_UP: f64 = 0.02;

impl CurveRun {
    pub(super) fn new(program: usize, settings: Settings, seed: u64, fault: Option<Fault>) -> Self {
        Self {
            program,
            settings,
            seed,
            planned: Vec::new(),
            tally: Tally::default(),
            bias_squared: MeanProduct::default(),
            non_finite: 0,
            per_sample: 0.0,
            fault,
        }
    }

    /// Warms up, measures the speed, and plans blocks that take the given processor time each.
    pub(super) fn plan(&mut self, process: &mut HostProcess, seconds: f64, lengths: u32) -> Result<()> {
        let mut samples = 1;
        self.per_sample = loop {
            // These renderings are discarded: they touch memory and caches for the first time.
            let Some(rendered) = self.job(process, samples, &[batch_seed(self.seed, u64::MAX)])? else {
                return Ok(());
            };
            if rendered.cpu_seconds > WARM_UP.min(seconds) || samples >= 1 << 20 {
                break rendered.cpu_seconds / samples as f64;
            }
            samples *= 2;
        };
        self.planned = levels(seconds, self.per_sample, lengths);
        self.tally.levels =
            self.planned.iter().map(|level| Level { samples: level.samples, blocks: Vec::new() }).collect();
        Ok(())
    }

    /// Renders one block of one length.
    pub(super) fn render(
        &mut self,
        process: &mut HostProcess,
        level: usize,
        block: usize,
        truth: Truth<'_>,
    ) -> Result<()> {
        let Some(&PlannedLevel { samples, renders }) = self.planned.get(level) else { return Ok(()) };
        let stream = batch_seed(batch_seed(self.seed, level as u64), block as u64);
        let seeds: Vec<u64> = (0..renders).map(|index| batch_seed(stream, index)).collect();
        let Some(rendered) = self.job(process, samples, &seeds)? else { return Ok(()) };
        let mut errors = Vec::with_capacity(seeds.len());
        for batch in rendered.batches {
            let image: Vec<[f64; 3]> = batch.into_iter().map(|pixel| pixel.map(f64::from)).collect();
            errors.push(Errors {
                relative_mse: relative_mse(&image, truth),
                trimmed_relative_mse: trimmed_relative_mse(&image, truth),
                mse: mse(&image, truth),
            });
            self.bias_squared.add(block % 2, &image, samples as f64);
        }
        let (seconds, rays) = (rendered.cpu_seconds, rendered.rays);
        self.tally.levels[level].blocks.push(Block { errors, seconds, rays });
        Ok(())
    }

    /// Renders images; `None` if the program has failed.
    fn job(&mut self, process: &mut HostProcess, samples: u64, seeds: &[u64]) -> Result<Option<Rendered>> {
        if self.fault.is_some() {
            return Ok(None);
        }
        let job = RenderJob::new(0, self.settings, [SIZE.0, SIZE.1], seeds.to_vec(), samples);
        match apart(process.render(&job))? {
            Ok(mut rendered) => {
                self.non_finite += rendered.non_finite;
                // A coarse clock must not yield a time of 0.
                rendered.cpu_seconds = rendered.cpu_seconds.max(1e-9);
                Ok(Some(rendered))
            }
            Err(fault) => {
                self.fault = Some(fault);
                Ok(None)
            }
        }
    }
}
