//! Grading a submission: from its source to its report.

mod inputs;
mod points;
mod run;
mod select;

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Instant;

use crate::audit::AuditOnce;
use crate::checks::{GradeContext, SceneWithReference};
use crate::diagnosis::Catalogue;
use crate::plan;
use crate::reference::Oracle;
use crate::statistics::sequential::{LOOKS, SCREENING_LEVEL};
use harness::assignment::Assignment;
use harness::build::{Framework, SubmissionProgram, compile};
use harness::host_process::HostProcess;
use harness::sandbox::{Limits, Machine};
use harness::scan::{self, scan};
use harness::trial;
use harness::workspace::Workspace;
use verdict::audit::Audit;
use verdict::check::{CheckResult, Numerics};
use verdict::error::Result;
use verdict::report::{
    Cost, Points, Provenance, Report, SCHEMA, Sandbox, SkippedCheck, SubmissionInfo, TaskResult, TaskState,
};
use verdict::rubric::Rubric;
use verdict::submission::{BuildFailure, IntakeFinding, Submission};
use verdict::text::clean;

use inputs::{hash_of_file, hash_of_references, load_scenes, require_references};
use select::{Selected, select};

pub use inputs::load_scene;

/// Options of a grade.
#[derive(Clone, Debug)]
pub struct Options {
    /// Name or folder of the assignment.
    pub assignment: String,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Number of threads of the submission.
    pub threads: usize,
    /// Checks to run, by identity, kind, scene, technique or task. All checks if empty.
    pub only: Vec<String>,
    /// Resource limits of the submission.
    pub limits: Limits,
}

/// Grades a submission. `on_check` is called after each check.
///
/// # Errors
/// If the grader itself fails.
pub fn grade(
    workspace: &Workspace,
    submission: &Submission,
    options: &Options,
    on_check: impl FnMut(&CheckResult) + Send,
) -> Result<Report> {
    Grader::new(workspace, options)?.grade(submission, on_check)
}

/// Grades submissions of one assignment. It prepares what they share once, and may grade several in parallel.
pub struct Grader {
    options: Options,
    rubric: Rubric,
    scenes: BTreeMap<String, SceneWithReference>,
    framework: Framework,
    framework_time: f64,
    oracle: Option<Oracle>,
    workspace: Workspace,
    /// Kinds of checks that do not apply to the scenes.
    skipped: Vec<SkippedCheck>,
    provenance: Provenance,
    /// The known mistakes.
    catalogue: Catalogue,
    /// Text of the assignment's starting file; empty if it has none.
    starter: String,
}

impl Grader {
    /// Loads rubric, scenes and references, and builds the framework.
    ///
    /// # Errors
    /// If any of these is invalid.
    pub fn new(workspace: &Workspace, options: &Options) -> Result<Self> {
        let assignment = Assignment::open(workspace, &options.assignment)?;
        let rubric = assignment.rubric.clone();
        plan::validate(&rubric)?;
        let selected = select(&rubric, &options.only)?;
        let start = Instant::now();
        // In parallel: finding that the framework is up to date uses one core.
        let (scenes, framework) = rayon::join(
            || load_scenes(workspace, &selected),
            || {
                let framework = assignment.framework(workspace)?;
                trial::require_that_submissions_work(&framework, &options.limits)?;
                Ok::<_, verdict::error::Error>(framework)
            },
        );
        let (scenes, framework) = (scenes?, framework?);
        plan::validate_in_scenes(&selected, &scenes)?;
        require_references(workspace, &selected, &scenes)?;
        let oracle = Oracle::of(workspace, &assignment, &framework)?;
        let framework_time = start.elapsed().as_secs_f64();
        let skipped = plan::skipped(&scenes);
        let provenance = Provenance {
            assignment: options.assignment.clone(),
            grader: env!("CARGO_PKG_VERSION").to_owned(),
            framework: framework.hash.clone(),
            rubric: hash_of_file(&assignment.folder.rubric_file())?,
            references: hash_of_references(&scenes),
            seed: Some(options.seed),
            secret_seed: false,
            toolchain: framework.toolchain.clone(),
            threads: options.threads,
        };
        Ok(Self {
            options: options.clone(),
            scenes,
            framework,
            framework_time,
            oracle,
            workspace: workspace.clone(),
            skipped,
            provenance,
            catalogue: Catalogue::load(&assignment.folder, &rubric)?,
            rubric,
            starter: assignment.folder.starter()?,
        })
    }

    /// The options.
    pub fn options(&self) -> &Options {
        &self.options
    }

    /// The framework that submissions are linked against.
    pub fn framework(&self) -> &Framework {
        &self.framework
    }

    /// The solution; `None` if the checkout does not have it.
    pub fn oracle(&self) -> Option<&Oracle> {
        self.oracle.as_ref()
    }

    /// The rubric of the assignment.
    pub fn rubric(&self) -> &Rubric {
        &self.rubric
    }

    /// Number of selected checks, of which a grade may skip some.
    pub fn planned(&self) -> usize {
        select(&self.rubric, &self.options.only).map_or(0, |selected| selected.len())
    }

    /// The same grader, whose reports tell the seed to staff only.
    #[must_use]
    pub fn with_secret_seed(mut self) -> Self {
        self.provenance.secret_seed = true;
        self
    }

    /// Seed of what everybody may see: that of the grade, unless it is secret.
    pub fn public_seed(&self) -> u64 {
        if self.provenance.secret_seed { 1 } else { self.options.seed }
    }

    /// Versions and seeds that all grades depend on.
    pub fn provenance(&self) -> &Provenance {
        &self.provenance
    }

    /// Grades a submission. `on_check` is called after each check.
    ///
    /// # Errors
    /// If the grader itself fails.
    pub fn grade(
        &self,
        submission: &Submission,
        on_check: impl FnMut(&CheckResult) + Send,
    ) -> Result<Report> {
        Ok(self.grade_or_refuse(submission, None, on_check)?.0)
    }

    /// Grades a submission and also returns its program; `None` if it does not compile.
    ///
    /// # Errors
    /// If the grader itself fails.
    pub fn grade_and_keep(
        &self,
        submission: &Submission,
        on_check: impl FnMut(&CheckResult) + Send,
    ) -> Result<(Report, Option<SubmissionProgram>)> {
        self.grade_or_refuse(submission, None, on_check)
    }

    /// The report on a submission that intake has refused: no points, with the reason.
    ///
    /// # Errors
    /// If the grader itself fails.
    pub fn refuse(&self, path: &Path, refusal: &IntakeFinding) -> Result<Report> {
        let nothing = Submission { path: path.to_owned(), source: String::new() };
        Ok(self.grade_or_refuse(&nothing, Some(refusal), |_| {})?.0)
    }

    fn grade_or_refuse(
        &self,
        submission: &Submission,
        refusal: Option<&IntakeFinding>,
        on_check: impl FnMut(&CheckResult) + Send,
    ) -> Result<(Report, Option<SubmissionProgram>)> {
        let start = Instant::now();
        let selected = select(&self.rubric, &self.options.only)?;
        let built = match refusal {
            None => compile(&self.framework, &submission.source, &self.options.limits)?,
            Some(refusal) => {
                Err(BuildFailure { messages: clean(&format!("{}\n", refusal.message)), line: None })
            }
        };
        let build = start.elapsed().as_secs_f64();

        let run_start = Instant::now();
        let mut results = self.initial_results(submission);
        if let Ok(program) = &built {
            self.run(program, &selected, &mut results, on_check)?;
        }
        let run = run_start.elapsed().as_secs_f64();
        let (program, build_failure) = match built {
            Ok(program) => (Some(program), None),
            Err(failure) => (None, Some(failure)),
        };
        let tasks = self.score(&selected, &results, build_failure.is_some(), refusal.is_some());
        let total = self.framework_time + start.elapsed().as_secs_f64();
        let mut report = Report {
            schema: SCHEMA.to_owned(),
            submission: SubmissionInfo {
                path: clean(&submission.path.display().to_string()),
                hash: submission.hash(),
                build_failure,
                explanations: Vec::new(),
                refusal: refusal.cloned(),
                notes: Vec::new(),
                prints: scan::prints(&submission.source),
                file_name: self.rubric.submission.name().to_owned(),
            },
            assignment: self.rubric.assignment.clone(),
            points: self.sum(&tasks),
            tasks,
            numerics: numerics_of(&results.checks),
            checks: results.checks,
            skipped: results.skipped,
            audit: results.audit,
            diagnosis: Vec::new(),
            cost: Cost { framework: self.framework_time, build, run, total },
            sandbox: results.sandbox,
            provenance: self.provenance.clone(),
            convergence: None,
            images: Vec::new(),
            hand_in: None,
        };
        report.diagnosis = self.catalogue.diagnose(&report, &submission.source, &self.starter);
        Ok((report, program))
    }

    /// The results before a submission is run.
    fn initial_results(&self, submission: &Submission) -> RunResults {
        let possible = Machine::here().layers();
        let sandbox = Sandbox::new(possible, possible, scan(&submission.source));
        RunResults { checks: Vec::new(), skipped: self.skipped.clone(), sandbox, audit: None }
    }

    /// Runs the selected checks that apply to their scenes.
    fn run(
        &self,
        program: &SubmissionProgram,
        selected: &Selected<'_>,
        results: &mut RunResults,
        on_check: impl FnMut(&CheckResult) + Send,
    ) -> Result<()> {
        let host = HostProcess::start(program, self.options.threads)?.layers();
        results.sandbox = Sandbox::new(program.layers, host, std::mem::take(&mut results.sandbox.findings));
        trial::require(&results.sandbox, self.options.limits.min_level)?;
        let audit = AuditOnce::new(program, self.options.seed);
        let context = GradeContext {
            program,
            audit: &audit,
            oracle: self.oracle.as_ref(),
            scenes: &self.scenes,
            workspace: &self.workspace,
            seed: self.options.seed,
            screening_level: SCREENING_LEVEL / self.rubric.checks().count() as f64,
            threads: self.options.threads,
            looks: LOOKS.len(),
        };
        let mut meaningful = selected.clone();
        meaningful.retain(|(_, spec)| {
            let why = plan::why_skipped(spec, self.scenes.get(&spec.scene), self.oracle.is_some());
            let is_meaningful = why.is_none();
            results.skipped.extend(why.map(|why| SkippedCheck {
                kind: spec.check,
                technique: spec.technique,
                scene: spec.scene.clone(),
                check: Some(spec.id()),
                why,
            }));
            is_meaningful
        });
        results.checks = run::run(&context, &meaningful, on_check)?;
        // A part of a grade answers a question of its own.
        if self.options.only.is_empty() && self.rubric.is_audited() {
            results.audit = Some(audit.all()?);
        }
        Ok(())
    }

    fn score(
        &self,
        selected: &Selected<'_>,
        results: &RunResults,
        not_compiled: bool,
        refused: bool,
    ) -> Vec<TaskResult> {
        let nothing_ran = match (refused, not_compiled) {
            (true, _) => Some(TaskState::NothingToGrade),
            (false, true) => Some(TaskState::NotCompiled),
            (false, false) => None,
        };
        let score =
            |task| points::score(task, selected, &results.checks, &results.skipped, nothing_ran.clone());
        points::require(&self.rubric, self.rubric.tasks.iter().map(score).collect(), &results.checks)
    }

    fn sum(&self, tasks: &[TaskResult]) -> Points {
        let total = |manual: bool| {
            let tasks = self.rubric.tasks.iter().filter(|task| task.manual == manual);
            // `Iterator::sum` of an empty iterator is −0.
            tasks.fold(0.0, |sum, task| sum + task.points)
        };
        Points {
            earned: tasks.iter().filter_map(|task| task.points).fold(0.0, |sum, points| sum + points),
            automatic_max: total(false),
            manual_max: total(true),
            max: total(false) + total(true),
            manual: None,
            staff_only: tasks.iter().map(|task| task.staff_only).sum(),
        }
    }
}

/// The results of running a submission.
struct RunResults {
    checks: Vec<CheckResult>,
    skipped: Vec<SkippedCheck>,
    sandbox: Sandbox,
    audit: Option<Audit>,
}

fn numerics_of(checks: &[CheckResult]) -> Numerics {
    Numerics {
        non_finite: checks.iter().map(|check| check.numerics.non_finite).sum(),
        negative: checks.iter().map(|check| check.numerics.negative).sum(),
        first: checks.iter().find_map(|check| check.numerics.first.clone()),
    }
}
