//! `cargo lab calibrate`.

use std::cell::OnceCell;
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use std::process::ExitCode;

use arty::integrator::Settings;
use host::protocol::Switches;
use indicatif::ProgressBar;

use crate::calibration::{Line, Pool, Quiet, Results, Test, Trial, svg, table};
use crate::mutants::{Kind, Ledger, Record, Variant, hash_of_inputs, variants};
use harness::assignment::Assignment;
use harness::build::{Framework, SubmissionProgram, compile};
use harness::host_process::Fault;
use harness::sandbox::Limits;
use harness::workspace::Workspace;
use judge::checks::JudgedScene;
use judge::grade::Options;
use judge::statistics::sequential::SCREENING_LEVEL;
use verdict::error::{Error, Result};
use verdict::rubric::{CheckKind, CheckSpec, Hits, Rubric};

/// Measure how often correct submissions fail, and how small an error is found (for staff).
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Grades to simulate, from recorded samples of the correct variants in turn
    #[arg(long, value_name = "N", default_value_t = 30_000)]
    resampled: u64,
    /// Simulated grades for each bias, of the solution
    #[arg(long, value_name = "N", default_value_t = 200)]
    power: u64,
    /// Simulated grades of each wrong variant in each check of the tasks that it costs, and draws without an error for
    /// the simpler tests; 0 leaves the comparison with these out
    #[arg(long, value_name = "N", default_value_t = 20)]
    rivals: u64,
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
    /// Folder of the results; those that are there already are used [default: target/calibration, and whole grades
    /// with those of `mutants` in target/mutants]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Threads [default: one for each core]
    #[arg(long, value_name = "N")]
    jobs: Option<usize>,
}

/// How much too bright samples are made, to see whether that is found.
const BIASES: [f64; 4] = [0.005, 0.01, 0.02, 0.05];

/// The checks that judge one picture by its mean.
const BY_MEANS: [CheckKind; 3] = [CheckKind::MeanBias, CheckKind::ClosedForm, CheckKind::WhiteFurnace];

/// How samples are recorded, drawn and judged.
const TRIALS: &str = concat!(
    include_str!("../calibration/mod.rs"),
    include_str!("../calibration/fixed.rs"),
    include_str!("../calibration/pool.rs")
);

/// The seed of all recorded samples and draws.
const SEED: u64 = 1;

pub(super) fn run(arguments: &Arguments) -> Result<ExitCode> {
    let workspace = Workspace::find()?;
    let rubric = arguments.assignment.rubric(&workspace)?;
    let (right, wrong): (Vec<Variant>, Vec<Variant>) =
        variants(&workspace, &rubric)?.list.into_iter().partition(|variant| variant.kind == Kind::Right);
    let folder =
        |name: &str| arguments.out.clone().unwrap_or_else(|| workspace.root().join("target").join(name));
    let mut calibration = Calibration {
        arguments,
        base: hash_of_inputs(&workspace, &arguments.assignment.name)?,
        threads: arguments.jobs.unwrap_or_else(rayon::current_num_threads).max(1),
        results: Results::open(&folder("calibration"))?,
        ledger: Ledger::open(&folder("mutants"), &workspace, &arguments.assignment.name)?,
        deadline: arguments.minutes.map(|minutes| {
            std::time::Instant::now() + std::time::Duration::from_secs_f64(60.0 * minutes.max(0.0))
        }),
        workspace: &workspace,
        rubric: &rubric,
        right: &right,
        wrong: &wrong,
        framework: Framework::build(&workspace)?,
        scenes: BTreeMap::new(),
    };
    calibration.resample()?;
    calibration.compare()?;
    calibration.grade()?;
    let (text, plot) = calibration.table();
    let write = |file: PathBuf, text: String| -> Result<()> {
        arty::image::write_aside(&file, |writer| std::io::Write::write_all(writer, text.as_bytes()))?;
        eprintln!("written: {}", file.display());
        Ok(())
    };
    write(workspace.calibration_table(), text)?;
    if let Some(plot) = plot {
        write(workspace.calibration_plot(), plot)?;
    }
    Ok(ExitCode::SUCCESS)
}

struct Calibration<'a> {
    arguments: &'a Arguments,
    workspace: &'a Workspace,
    rubric: &'a Rubric,
    right: &'a [Variant],
    wrong: &'a [Variant],
    framework: Framework,
    scenes: BTreeMap<String, JudgedScene>,
    /// Over what is the same for all variants.
    base: blake3::Hash,
    threads: usize,
    results: Results,
    ledger: Ledger,
    deadline: Option<std::time::Instant>,
}

impl Calibration<'_> {
    fn is_over(&self) -> bool {
        self.deadline.is_some_and(|deadline| std::time::Instant::now() >= deadline)
    }

    /// Over all that what is drawn from a variant's samples depends on.
    fn key(&self, variant: &Variant) -> String {
        let solution = self.right.first().map_or("", |solution| solution.source.as_str());
        let mut hasher = blake3::Hasher::new();
        hasher.update(self.base.as_bytes()).update(&self.arguments.pool.to_le_bytes());
        for text in [TRIALS.as_bytes(), solution.as_bytes(), variant.source.as_bytes()] {
            hasher.update(blake3::hash(text).as_bytes());
        }
        hasher.finalize().to_hex()[..32].to_owned()
    }

    /// The checks of the rubric that judge one picture by its mean.
    fn checks(&self) -> Vec<&CheckSpec> {
        self.rubric.checks().map(|(_, spec)| spec).filter(|spec| BY_MEANS.contains(&spec.check)).collect()
    }

    /// The statistics alone.
    fn resample(&mut self) -> Result<()> {
        let checks: Vec<CheckSpec> = self.checks().into_iter().cloned().collect();
        let share = self.arguments.resampled.div_ceil(self.right.len().max(1) as u64);
        let bar = ProgressBar::new((checks.len() * self.right.len()) as u64).with_message("resampling");
        let rivals = self.arguments.rivals;
        for (number, variant) in self.right.iter().enumerate() {
            let program = self.compile(variant)?;
            for spec in &checks {
                let mut wanted = vec![(Test::Sequential, 0.0, share)];
                if number == 0 {
                    wanted.extend(BIASES.map(|bias| (Test::Sequential, bias, self.arguments.power)));
                    for test in [Test::Welch, Test::Pixels] {
                        wanted.extend([0.0, 0.01, 0.02, 0.05].map(|bias| (test, bias, rivals)));
                    }
                }
                if self.is_over() {
                    return Ok(());
                }
                self.try_check(
                    variant,
                    spec,
                    &wanted,
                    |recorder| recorder.correct(&program).map(Some),
                    None,
                )?;
                bar.inc(1);
            }
        }
        bar.finish_and_clear();
        Ok(())
    }

    /// All tests on wrong variants, in the checks of the tasks that these cost.
    fn compare(&mut self) -> Result<()> {
        let Some(solution) = self.right.first() else { return Ok(()) };
        let (rubric, wrong) = (self.rubric, self.wrong);
        let by_means = |spec: &&CheckSpec| BY_MEANS.contains(&spec.check);
        let checks = || rubric.tasks.iter().flat_map(|task| task.checks.iter().map(move |spec| (task, spec)));
        let bar = ProgressBar::new(checks().filter(|(_, spec)| by_means(spec)).count() as u64)
            .with_message("wrong variants");
        let solution = self.compile(solution)?;
        let programs: Vec<SubmissionProgram> =
            wrong.iter().map(|variant| self.compile(variant)).collect::<Result<_>>()?;
        for (task, spec) in checks().filter(|(_, spec)| by_means(spec)) {
            // What is right is recorded once for all that is wrong, and not before it is needed.
            let truth = OnceCell::new();
            for (variant, program) in wrong.iter().zip(&programs) {
                if self.is_over() {
                    return Ok(());
                }
                if !variant.costs.contains(&task.id) {
                    continue;
                }
                let wanted = Test::ALL.map(|test| (test, 0.0, self.arguments.rivals));
                // What does not even render is found by that, whatever the test.
                let record = |recorder: &Recorder<'_>| recorder.record(program).map(std::result::Result::ok);
                self.try_check(variant, spec, &wanted, record, Some((&solution, &truth)))?;
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

    /// Whatever is wanted of one check and not yet known. `record` gives the samples that are judged, if there are any;
    /// `truth` those of a correct program, recorded by now or not, if they are wrong.
    fn try_check(
        &mut self,
        variant: &Variant,
        spec: &CheckSpec,
        wanted: &[(Test, f64, u64)],
        record: impl FnOnce(&Recorder<'_>) -> Result<Option<Pool>>,
        truth: Option<(&SubmissionProgram, &OnceCell<(Pool, Quiet)>)>,
    ) -> Result<()> {
        let (key, mut wanted) = (self.key(variant), wanted.to_vec());
        wanted.retain(|&(test, bias, count)| {
            let known = self.results.find(&key, &variant.id, &spec.id(), test, bias);
            count > 0 && known.is_none_or(|line| test == Test::Sequential && line.counts.grades < count)
        });
        if wanted.is_empty() {
            return Ok(());
        }
        if !self.scenes.contains_key(&spec.scene) {
            let scene = judge::grade::load_scene(self.workspace, &spec.scene)?;
            self.scenes.insert(spec.scene.clone(), scene);
        }
        let judged = &self.scenes[&spec.scene];
        let recorder = Recorder { judged, spec, count: self.arguments.pool, threads: self.threads };
        let Some(pool) = record(&recorder)? else { return Ok(()) };
        let own = Quiet::default();
        let (truth, quiet) = match truth {
            None => (&pool, &own),
            Some((program, truth)) => match truth.get() {
                Some((truth, quiet)) => (truth, quiet),
                None => {
                    let recorded = recorder.correct(program)?;
                    let (truth, quiet) = truth.get_or_init(|| (recorded, Quiet::default()));
                    (truth, quiet)
                }
            },
        };
        let expected = judge::checks::expected_by_reference(spec, &judged.reference)?;
        let trial = Trial {
            pool: &pool,
            truth,
            quiet,
            expected: &expected,
            tolerance: spec.tolerance,
            screening_level: SCREENING_LEVEL / self.rubric.checks().count() as f64,
        };
        for (test, bias, count) in wanted {
            let counts = trial.run(test, count, bias, SEED);
            let (key, variant, check) = (key.clone(), variant.id.clone(), spec.id());
            let seconds_per_path = pool.seconds_per_path();
            self.results.add(Line { key, variant, check, test, bias, counts, seconds_per_path })?;
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

    fn table(&self) -> (String, Option<String>) {
        let variants = self.right.iter().chain(self.wrong);
        let keys: BTreeSet<String> = variants.map(|variant| self.key(variant)).collect();
        let lines: Vec<&Line> = self.results.of(&keys).collect();
        let mut checks: Vec<String> = self.checks().iter().map(|spec| spec.id()).collect();
        checks.dedup();
        let wrong: Vec<String> = self.wrong.iter().map(|variant| variant.id.clone()).collect();
        let grades: BTreeMap<String, Vec<&Record>> =
            self.right.iter().map(|variant| (variant.id.clone(), self.ledger.records(variant))).collect();
        (table(&lines, &wrong, &checks, &grades), svg(&lines, &wrong))
    }
}

/// Records samples for one check.
struct Recorder<'a> {
    judged: &'a JudgedScene,
    spec: &'a CheckSpec,
    count: u64,
    threads: usize,
}

impl Recorder<'_> {
    /// Of a program that may do anything.
    fn record(&self, program: &SubmissionProgram) -> Result<std::result::Result<Pool, Fault>> {
        let Self { judged, spec, count, threads } = *self;
        let settings = Settings { technique: spec.technique, max_bounces: spec.max_bounces };
        let switches = Switches { emission_on_hit: spec.hits == Hits::On };
        Pool::record(program, &judged.description, settings, switches, count, threads, SEED)
    }

    /// Of one that must not fail.
    fn correct(&self, program: &SubmissionProgram) -> Result<Pool> {
        self.record(program)?.map_err(|fault| Error::Harness(format!("a correct variant: {fault}")))
    }
}
