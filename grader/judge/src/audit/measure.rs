//! Measuring chains.
//!
//! Most submissions make no random decision in a short chain with one light, so that a few paths give the exact result.
//! Where paths differ, eight stratified sets of paths give a mean and its standard error.

use std::time::Duration;

use arty::integrator::{Settings, Technique};
use harness::host_process::HostProcess;
use harness::job::JobError;
use host::protocol::{AuditJob, AuditRun, AuditedRun};

use super::chain::Chain;

/// A chain and how it is traced.
#[derive(Clone, Debug)]
pub(super) struct Case {
    pub(super) chain: Chain,
    pub(super) technique: Technique,
    pub(super) max_bounces: u32,
    pub(super) emission_on_hit: bool,
}

/// The mean radiance of a case.
#[derive(Clone, Copy, Debug)]
pub(super) struct Measured {
    /// The red channel.
    pub(super) value: f64,
    /// All channels.
    pub(super) all: [f64; 3],
    /// Standard error of the red channel; 0 if all paths agree.
    pub(super) error: f64,
    /// Standard errors of all channels.
    errors: [f64; 3],
}

/// Numbers of paths to trace.
#[derive(Clone, Copy, Debug)]
pub(super) struct Effort {
    /// Paths that show whether there are random decisions.
    pub(super) first: u32,
    /// Paths of each of eight sets if there are.
    pub(super) set: u32,
    /// Maximum number of cases that are measured by sets; the others have the result `None`.
    pub(super) most: usize,
}

impl Effort {
    /// The effort of most facts.
    pub(super) const USUAL: Self = Self { first: 64, set: 256, most: usize::MAX };
}

/// Number of sets of paths.
const SETS: u32 = 8;

/// Relative spread of paths that differ by rounding only.
const ROUNDING: f64 = 1e-5;

/// A process of the submission that is measured.
pub(super) struct Prober<'a> {
    pub(super) process: &'a mut HostProcess,
    pub(super) seed: u32,
    /// Time limit of one job.
    pub(super) time: Duration,
}

impl Case {
    /// A case that may have one more bounce than the chain.
    pub(super) fn new(chain: Chain, technique: Technique) -> Self {
        let max_bounces = chain.surfaces.len() as u32 + 1;
        Self { chain, technique, max_bounces, emission_on_hit: true }
    }

    /// The same without emission on hits, so that only light samples contribute.
    pub(super) fn light_samples_only(mut self) -> Self {
        self.emission_on_hit = false;
        self
    }

    fn run(&self, scene: u32, paths: u32, seed: u32, with_extreme: bool) -> AuditRun {
        let settings = Settings { technique: self.technique, max_bounces: self.max_bounces };
        AuditRun { scene, settings, seed, emission_on_hit: self.emission_on_hit, paths, with_extreme }
    }
}

impl Measured {
    fn exact(run: &AuditedRun) -> Self {
        Self { value: run.mean[0], all: run.mean, error: 0.0, errors: [0.0; 3] }
    }

    /// The mean of sets of so many paths.
    fn of_sets(runs: &[AuditedRun], paths: u32) -> Self {
        let count = runs.len() as f64;
        let all: [f64; 3] =
            std::array::from_fn(|channel| runs.iter().map(|run| run.mean[channel]).sum::<f64>() / count);
        let errors: [f64; 3] = std::array::from_fn(|channel| {
            let squares = runs.iter().map(|run| (run.mean[channel] - all[channel]).powi(2)).sum::<f64>();
            // Strata round the probability of a decision, perhaps in all sets alike.
            let spread = runs.iter().map(|run| run.spread[channel]).sum::<f64>() / count;
            (squares / (count - 1.0) / count).sqrt().max(spread / (2.0 * f64::from(paths)))
        });
        Self { value: all[0], all, error: errors[0], errors }
    }

    /// Standard error of a channel.
    pub(super) fn channel_error(&self, channel: usize) -> f64 {
        self.errors[channel]
    }

    /// The difference of two measurements with the same random numbers.
    pub(super) fn minus(self, other: Self) -> Self {
        Self {
            value: self.value - other.value,
            all: std::array::from_fn(|channel| self.all[channel] - other.all[channel]),
            error: self.error.hypot(other.error),
            errors: std::array::from_fn(|channel| self.errors[channel].hypot(other.errors[channel])),
        }
    }
}

impl Prober<'_> {
    /// Measures cases, in their order.
    pub(super) fn measure(
        &mut self,
        cases: &[Case],
        effort: Effort,
    ) -> Result<Vec<Option<Measured>>, JobError> {
        let scenes: Vec<_> = cases.iter().map(|case| case.chain.scene()).collect();
        let first = cases.iter().zip(0..).map(|(case, scene)| case.run(scene, effort.first, self.seed, true));
        let job = AuditJob { runs: first.collect(), scenes };
        let first = self.process.audit(&job, self.time)?;
        let differs =
            |run: &AuditedRun| (0..3).any(|channel| run.spread[channel] > ROUNDING * run.mean[channel].abs());
        let differing: Vec<usize> = (0..cases.len()).filter(|&index| differs(&first[index])).collect();
        let measured: Vec<usize> = differing.iter().copied().take(effort.most).collect();
        let mut results: Vec<Option<Measured>> = first.iter().map(Measured::exact).map(Some).collect();
        differing.iter().for_each(|&index| results[index] = None);
        if measured.is_empty() {
            return Ok(results);
        }
        let scenes = measured.iter().map(|&index| cases[index].chain.scene()).collect();
        let seed = self.seed;
        let sets = |(&index, scene): (&usize, u32)| {
            let case = &cases[index];
            (1..=SETS).map(move |set| case.run(scene, effort.set, seed.wrapping_add(set), false))
        };
        let runs = measured.iter().zip(0..).flat_map(sets).collect();
        let sets = self.process.audit(&AuditJob { scenes, runs }, self.time)?;
        for (&index, runs) in measured.iter().zip(sets.chunks(SETS as usize)) {
            results[index] = Some(Measured::of_sets(runs, effort.set));
        }
        Ok(results)
    }

    /// Measures cases with the usual effort, in their order.
    pub(super) fn measure_all(&mut self, cases: &[Case]) -> Result<Vec<Measured>, JobError> {
        Ok(self.measure(cases, Effort::USUAL)?.into_iter().flatten().collect())
    }

    /// The maximum number of rays of a path, by case.
    pub(super) fn rays(&mut self, cases: &[Case]) -> Result<Vec<u32>, JobError> {
        let scenes = cases.iter().map(|case| case.chain.scene()).collect();
        let runs =
            cases.iter().zip(0..).map(|(case, scene)| case.run(scene, Effort::USUAL.set, self.seed, false));
        let job = AuditJob { runs: runs.collect(), scenes };
        Ok(self.process.audit(&job, self.time)?.into_iter().map(|run| run.rays[1]).collect())
    }
}
