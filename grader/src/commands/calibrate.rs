//! `grader calibrate`.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::process::ExitCode;

use arty::integrator::Settings;
use host::protocol::Switches;
use indicatif::ProgressBar;

use super::assignment::Assignment;
use crate::build::{Framework, HandInProgram, compile};
use crate::calibration::{Line, Pool, Results, Trial, table};
use crate::checks::JudgedScene;
use crate::error::{Error, Result};
use crate::grade::Options;
use crate::mutants::{Kind, Ledger, Record, Variant, hash_of_inputs, variants};
use crate::rubric::{CheckKind, CheckSpec, Hits, Rubric};
use crate::sandbox::Limits;
use crate::statistics::sequential::SCREENING_LEVEL;
use crate::workspace::Workspace;

/// Measure how often correct hand-ins fail, and how small an error is found (for staff).
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Grades to simulate, from recorded samples of the correct variants in turn
    #[arg(long, value_name = "N", default_value_t = 30_000)]
    resampled: u64,
    /// Simulated grades for each bias, of the solution
    #[arg(long, value_name = "N", default_value_t = 200)]
    power: u64,
    /// Whole grades, of the correct variants in turn
    #[arg(long, value_name = "N", default_value_t = 1000)]
    grades: u64,
    /// Images of one sample to record for each check
    #[arg(long, value_name = "N", default_value_t = 8192)]
    pool: u64,
    /// Stop after this many minutes; the next call goes on from there
    #[arg(long, value_name = "MINUTES")]
    minutes: Option<f64>,
    #[command(flatten)]
    assignment: Assignment,
    /// Folder of the results; those that are there already are used [default: target/calibration]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Threads [default: one for each core]
    #[arg(long, value_name = "N")]
    jobs: Option<usize>,
}

/// How much too bright samples are made, to see whether that is found.
const BIASES: [f64; 4] = [0.005, 0.01, 0.02, 0.05];

/// The seed of all recorded samples and draws.
const SEED: u64 = 1;

pub(super) fn run(arguments: &Arguments) -> Result<ExitCode> {
    let workspace = Workspace::find()?;
    let rubric = arguments.assignment.rubric(&workspace)?;
    let right: Vec<Variant> = variants(&workspace, &rubric)?
        .list
        .into_iter()
        .filter(|variant| variant.kind == Kind::Right)
        .collect();
    let folder = arguments.out.clone().unwrap_or_else(|| workspace.root().join("target/calibration"));
    let mut calibration = Calibration {
        arguments,
        key: hash_of_inputs(&workspace, &arguments.assignment.name)?.to_hex()[..32].to_owned(),
        threads: arguments.jobs.unwrap_or_else(rayon::current_num_threads).max(1),
        results: Results::open(&folder)?,
        ledger: Ledger::open(&folder, &workspace, &arguments.assignment.name)?,
        deadline: arguments.minutes.map(|minutes| {
            std::time::Instant::now() + std::time::Duration::from_secs_f64(60.0 * minutes.max(0.0))
        }),
        workspace: &workspace,
        rubric: &rubric,
        right: &right,
    };
    calibration.resample()?;
    calibration.grade()?;
    let text = calibration.table();
    let file = workspace.calibration_table();
    arty::image::write_aside(&file, |writer| std::io::Write::write_all(writer, text.as_bytes()))?;
    eprintln!("table: {}", file.display());
    Ok(ExitCode::SUCCESS)
}

struct Calibration<'a> {
    arguments: &'a Arguments,
    workspace: &'a Workspace,
    rubric: &'a Rubric,
    right: &'a [Variant],
    key: String,
    threads: usize,
    results: Results,
    ledger: Ledger,
    deadline: Option<std::time::Instant>,
}

impl Calibration<'_> {
    fn is_over(&self) -> bool {
        self.deadline.is_some_and(|deadline| std::time::Instant::now() >= deadline)
    }

    /// The checks of the rubric that judge one picture by its mean.
    fn checks(&self) -> Vec<&CheckSpec> {
        let by_means = [CheckKind::MeanBias, CheckKind::ClosedForm, CheckKind::WhiteFurnace];
        self.rubric.checks().map(|(_, spec)| spec).filter(|spec| by_means.contains(&spec.check)).collect()
    }

    /// The statistics alone.
    fn resample(&mut self) -> Result<()> {
        let framework = Framework::build(self.workspace)?;
        let checks: Vec<CheckSpec> = self.checks().into_iter().cloned().collect();
        let share = self.arguments.resampled.div_ceil(self.right.len().max(1) as u64);
        let bar = ProgressBar::new((checks.len() * self.right.len()) as u64);
        let mut scenes = BTreeMap::new();
        for (number, variant) in self.right.iter().enumerate() {
            let program = match compile(&framework, &variant.source, &Limits::default())? {
                Ok(program) => program,
                Err(failure) => return Err(Error::Harness(format!("{}: {}", variant.id, failure.messages))),
            };
            for spec in &checks {
                if self.is_over() {
                    return Ok(());
                }
                let mut wanted = vec![(0.0, share)];
                if number == 0 {
                    wanted.extend(BIASES.map(|bias| (bias, self.arguments.power)));
                }
                wanted.retain(|&(bias, count)| {
                    let known = self.results.find(&self.key, &variant.id, &spec.id(), bias);
                    count > 0 && known.is_none_or(|line| line.counts.grades < count)
                });
                if !wanted.is_empty() {
                    let judged = match scenes.entry(spec.scene.clone()) {
                        std::collections::btree_map::Entry::Occupied(entry) => entry.into_mut(),
                        std::collections::btree_map::Entry::Vacant(entry) => {
                            entry.insert(crate::grade::load_scene(self.workspace, &spec.scene)?)
                        }
                    };
                    self.try_check(&program, variant, spec, judged, &wanted)?;
                }
                bar.inc(1);
            }
        }
        bar.finish_and_clear();
        Ok(())
    }

    fn try_check(
        &mut self,
        program: &HandInProgram,
        variant: &Variant,
        spec: &CheckSpec,
        judged: &JudgedScene,
        wanted: &[(f64, u64)],
    ) -> Result<()> {
        let settings = Settings { technique: spec.technique, max_bounces: spec.max_bounces };
        let switches = Switches { hits_off: spec.hits == Hits::Off, ..Switches::default() };
        let count = self.arguments.pool;
        let pool = Pool::record(program, &judged.description, settings, switches, count, self.threads, SEED)?;
        let expected = crate::checks::expected_by_reference(spec, &judged.reference)?;
        let trial = Trial {
            pool: &pool,
            expected: &expected,
            tolerance: spec.tolerance,
            screening_level: SCREENING_LEVEL / self.rubric.checks().count() as f64,
        };
        for &(bias, count) in wanted {
            let counts = trial.run(count, bias, SEED);
            let (key, variant, check) = (self.key.clone(), variant.id.clone(), spec.id());
            self.results.add(Line { key, variant, check, bias, counts })?;
        }
        Ok(())
    }

    /// Whole grades.
    fn grade(&mut self) -> Result<()> {
        let bar = ProgressBar::new(self.arguments.grades);
        let (grades, variants) = (self.arguments.grades, self.right.len() as u64);
        for seed in 1..=grades.div_ceil(variants) {
            let wanted = (grades - (seed - 1) * variants).min(variants) as usize;
            let right: Vec<&Variant> = self.right.iter().take(wanted).collect();
            let options = Options {
                assignment: self.arguments.assignment.name.clone(),
                seed,
                threads: self.threads,
                only: Vec::new(),
                limits: Limits::default(),
            };
            let deadline = self.deadline;
            let is_over = || deadline.is_some_and(|deadline| std::time::Instant::now() >= deadline);
            if is_over() {
                break;
            }
            self.ledger.grade(self.workspace, &right, &options, is_over, |_| bar.inc(1))?;
        }
        bar.finish_and_clear();
        Ok(())
    }

    fn table(&self) -> String {
        let lines: Vec<&Line> = self.results.of(&self.key).collect();
        let mut checks: Vec<String> = self.checks().iter().map(|spec| spec.id()).collect();
        checks.dedup();
        let grades: BTreeMap<String, Vec<&Record>> =
            self.right.iter().map(|variant| (variant.id.clone(), self.ledger.records(variant))).collect();
        table(&lines, &checks, &grades)
    }
}
