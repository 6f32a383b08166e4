//! The experiment: which variants, checks, tests and biases are simulated, and which grades are run.

use std::cell::OnceCell;
use std::collections::{BTreeMap, BTreeSet};
use std::time::Instant;

use arty::integrator::Settings;
use host::protocol::Switches;
use indicatif::ProgressBar;

use super::{AlarmCache, Line, Pool, Results, Test, Trial, svg, table};
use crate::mutants::{Ledger, Record, Variant};
use harness::build::{Framework, SubmissionProgram, compile};
use harness::job::{JobError, apart};
use harness::sandbox::Limits;
use harness::workspace::Workspace;
use judge::checks::{SceneWithReference, expected_by_reference};
use judge::grade::{Options, load_scene};
use judge::statistics::sequential::SCREENING_LEVEL;
use verdict::check::{CheckId, CheckKind};
use verdict::error::{Error, Result};
use verdict::rubric::{CheckSpec, EmissionOnHit, Rubric};

/// Relative errors that are added to the samples of the solution.
const BIASES: [f64; 4] = [0.005, 0.01, 0.02, 0.05];

/// The same for the tests of fixed size, without an error first.
const BIASES_OF_FIXED: [f64; 4] = [0.0, 0.01, 0.02, 0.05];

/// Checks that decide on the mean of one picture.
const CHECKS_OF_MEANS: [CheckKind; 3] = [CheckKind::MeanBias, CheckKind::ClosedForm, CheckKind::WhiteFurnace];

/// The code that records, draws and judges samples: part of the key of a result.
const TRIAL_CODE: &str = concat!(include_str!("mod.rs"), include_str!("fixed.rs"), include_str!("pool.rs"));

/// Seed of all recorded samples and draws.
const SEED: u64 = 1;

/// How much is simulated and graded.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Simulated grades of the correct variants in turn.
    pub resampled: u64,
    /// Simulated grades of the solution at each bias.
    pub power: u64,
    /// Simulated grades of each wrong variant in each check of the tasks that it costs; 0 skips the simpler tests.
    pub rivals: u64,
    /// Whole grades of the correct variants in turn.
    pub grades: u64,
    /// Images of one sample per pixel that are recorded for each check.
    pub pool: u64,
}

/// Everything that the experiment needs. What is known from earlier runs is not computed again.
pub struct Experiment<'a> {
    /// How much is simulated and graded.
    pub effort: Effort,
    /// The checkout.
    pub workspace: &'a Workspace,
    /// Name of the assignment.
    pub assignment: &'a str,
    /// Rubric of the assignment, with the checks to calibrate.
    pub rubric: &'a Rubric,
    /// The correct variants, the solution first.
    pub right: &'a [Variant],
    /// The wrong variants.
    pub wrong: &'a [Variant],
    /// What submissions are linked against.
    pub framework: Framework,
    /// Hash of everything that is the same for all variants.
    pub base: blake3::Hash,
    /// Threads of each program, and number of grades at the same time.
    pub threads: usize,
    /// Results of simulations.
    pub results: Results,
    /// Results of whole grades.
    pub ledger: Ledger,
    /// Time at which no further step is begun.
    pub deadline: Option<Instant>,
}

impl Experiment<'_> {
    /// Runs all steps, as far as the deadline allows.
    ///
    /// # Errors
    /// If a correct variant fails to compile or to answer, or a result cannot be written.
    pub fn run(&mut self) -> Result<()> {
        let mut scenes = BTreeMap::new();
        self.simulate_right(&mut scenes)?;
        self.simulate_wrong(&mut scenes)?;
        self.grade()
    }

    /// The tables as Markdown and the plot as SVG, from all results that are known.
    pub fn summary(&self) -> (String, Option<String>) {
        let variants = self.right.iter().chain(self.wrong);
        let keys: BTreeSet<String> = variants.map(|variant| self.key(variant)).collect();
        let lines: Vec<&Line> = self.results.of(&keys).collect();
        let mut checks: Vec<CheckId> = self.checks().iter().map(CheckSpec::id).collect();
        checks.dedup();
        let wrong: Vec<String> = self.wrong.iter().map(|variant| variant.id.clone()).collect();
        let grades: BTreeMap<String, Vec<&Record>> =
            self.right.iter().map(|variant| (variant.id.clone(), self.ledger.records(variant))).collect();
        (table(&lines, &wrong, &checks, &grades), svg(&lines, &wrong))
    }

    fn is_over(&self) -> bool {
        self.deadline.is_some_and(|deadline| Instant::now() >= deadline)
    }

    /// Hash of everything that the simulations of a variant depend on.
    fn key(&self, variant: &Variant) -> String {
        let solution = self.right.first().map_or("", |solution| solution.source.as_str());
        let mut hasher = blake3::Hasher::new();
        hasher.update(self.base.as_bytes()).update(&self.effort.pool.to_le_bytes());
        for text in [TRIAL_CODE.as_bytes(), solution.as_bytes(), variant.source.as_bytes()] {
            hasher.update(blake3::hash(text).as_bytes());
        }
        hasher.finalize().to_hex()[..32].to_owned()
    }

    /// The checks of means in the rubric.
    fn checks(&self) -> Vec<CheckSpec> {
        let specs = self.rubric.checks().map(|(_, spec)| spec);
        specs.filter(|spec| CHECKS_OF_MEANS.contains(&spec.check)).cloned().collect()
    }

    /// Simulates the correct variants: false alarms of all of them, and power on the solution.
    fn simulate_right(&mut self, scenes: &mut Scenes) -> Result<()> {
        let checks = self.checks();
        let Effort { resampled, power, rivals, .. } = self.effort;
        let share = resampled.div_ceil(self.right.len().max(1) as u64);
        let bar = ProgressBar::new((checks.len() * self.right.len()) as u64).with_message("resampling");
        for (number, variant) in self.right.iter().enumerate() {
            let program = self.compile(variant)?;
            for spec in &checks {
                let mut wanted = vec![(Test::Sequential, 0.0, share)];
                if number == 0 {
                    wanted.extend(BIASES.map(|bias| (Test::Sequential, bias, power)));
                    for test in [Test::Welch, Test::Pixels] {
                        wanted.extend(BIASES_OF_FIXED.map(|bias| (test, bias, rivals)));
                    }
                }
                if self.is_over() {
                    return Ok(());
                }
                let record = |recorder: &Recorder<'_>| recorder.trusted(&program).map(Some);
                self.simulate(variant, spec, &wanted, scenes, record, None)?;
                bar.inc(1);
            }
        }
        bar.finish_and_clear();
        Ok(())
    }

    /// Applies all tests to the wrong variants, in the checks of the tasks that these cost.
    fn simulate_wrong(&mut self, scenes: &mut Scenes) -> Result<()> {
        let Some(solution) = self.right.first() else { return Ok(()) };
        let (rubric, wrong) = (self.rubric, self.wrong);
        let checks = || rubric.checks().filter(|(_, spec)| CHECKS_OF_MEANS.contains(&spec.check));
        let bar = ProgressBar::new(checks().count() as u64).with_message("wrong variants");
        let solution = self.compile(solution)?;
        let programs: Vec<SubmissionProgram> =
            wrong.iter().map(|variant| self.compile(variant)).collect::<Result<_>>()?;
        for (task, spec) in checks() {
            // Recorded once for all wrong variants, and only when one of them needs it.
            let truth = OnceCell::new();
            for (variant, program) in wrong.iter().zip(&programs) {
                if self.is_over() {
                    return Ok(());
                }
                if !variant.costs.contains(&task.id) {
                    continue;
                }
                let wanted = Test::ALL.map(|test| (test, 0.0, self.effort.rivals));
                // A program that does not even render is found without any test.
                let record = |recorder: &Recorder<'_>| apart(recorder.record(program)).map(|pool| pool.ok());
                self.simulate(variant, spec, &wanted, scenes, record, Some((&solution, &truth)))?;
            }
            bar.inc(1);
        }
        bar.finish_and_clear();
        Ok(())
    }

    fn compile(&self, variant: &Variant) -> Result<SubmissionProgram> {
        compile(&self.framework, &variant.source, &Limits::default())?
            .map_err(|failure| Error::Harness(format!("{}: {}", variant.id, failure.messages)))
    }

    /// Simulates what is wanted of one check and not known yet. `record` gives the samples that are judged, if the program
    /// gives any; `truth` a correct program and the cell for its samples, where `variant` is wrong.
    fn simulate(
        &mut self,
        variant: &Variant,
        spec: &CheckSpec,
        wanted: &[(Test, f64, u64)],
        scenes: &mut Scenes,
        record: impl FnOnce(&Recorder<'_>) -> Result<Option<Pool>>,
        truth: Option<(&SubmissionProgram, &OnceCell<(Pool, AlarmCache)>)>,
    ) -> Result<()> {
        let (key, check, mut wanted) = (self.key(variant), spec.id(), wanted.to_vec());
        wanted.retain(|&(test, bias, count)| {
            let known = self.results.find(&key, &variant.id, &check, test, bias);
            count > 0 && known.is_none_or(|line| test == Test::Sequential && line.counts.grades < count)
        });
        if wanted.is_empty() {
            return Ok(());
        }
        if !scenes.contains_key(&spec.scene) {
            scenes.insert(spec.scene.clone(), load_scene(self.workspace, &spec.scene)?);
        }
        let scene = &scenes[&spec.scene];
        let recorder = Recorder { scene, spec, count: self.effort.pool, threads: self.threads };
        let Some(pool) = record(&recorder)? else { return Ok(()) };
        let own = AlarmCache::default();
        let (truth, alarms) = match truth {
            None => (&pool, &own),
            Some((program, truth)) => {
                if truth.get().is_none() {
                    let recorded = (recorder.trusted(program)?, AlarmCache::default());
                    let _ = truth.set(recorded);
                }
                truth.get().map_or((&pool, &own), |(truth, alarms)| (truth, alarms))
            }
        };
        let trial = Trial {
            pool: &pool,
            truth,
            alarms,
            expected: &expected_by_reference(spec, &scene.reference)?,
            tolerance: spec.tolerance,
            screening_level: SCREENING_LEVEL / self.rubric.checks().count() as f64,
        };
        for (test, bias, count) in wanted {
            let counts = trial.run(test, count, bias, SEED);
            let (key, variant, check) = (key.clone(), variant.id.clone(), check.clone());
            let seconds_per_path = pool.seconds_per_path();
            self.results.add(Line { key, variant, check, test, bias, counts, seconds_per_path })?;
        }
        Ok(())
    }

    /// Runs whole grades of the correct variants, seed by seed.
    fn grade(&mut self) -> Result<()> {
        let bar = ProgressBar::new(self.effort.grades);
        let (grades, variants) = (self.effort.grades, self.right.len() as u64);
        for seed in 1..=grades.div_ceil(variants) {
            let wanted = (grades - (seed - 1) * variants).min(variants) as usize;
            let right: Vec<&Variant> = self.right.iter().take(wanted).collect();
            let options = Options {
                assignment: self.assignment.to_owned(),
                seed,
                threads: self.threads,
                only: Vec::new(),
                limits: Limits::default(),
            };
            let deadline = self.deadline;
            let is_over = || deadline.is_some_and(|deadline| Instant::now() >= deadline);
            if is_over() {
                break;
            }
            self.ledger.grade(self.workspace, &right, &options, is_over, |_| bar.inc(1))?;
        }
        bar.finish_and_clear();
        Ok(())
    }
}

type Scenes = BTreeMap<String, SceneWithReference>;

/// Records samples for one check.
struct Recorder<'a> {
    scene: &'a SceneWithReference,
    spec: &'a CheckSpec,
    count: u64,
    threads: usize,
}

impl Recorder<'_> {
    /// Samples of a program that may do anything.
    fn record(&self, program: &SubmissionProgram) -> std::result::Result<Pool, JobError> {
        let Self { scene, spec, count, threads } = *self;
        let settings = Settings { technique: spec.technique, max_bounces: spec.max_bounces };
        let switches = Switches { emission_on_hit: spec.emission_on_hit == EmissionOnHit::On };
        Pool::record(program, &scene.description, settings, switches, count, threads, SEED)
    }

    /// Samples of a correct program, whose faults are the harness's.
    fn trusted(&self, program: &SubmissionProgram) -> Result<Pool> {
        self.record(program).map_err(|error| error.of_trusted("a correct variant"))
    }
}
