//! Grading one hand-in, from its file to its report.

mod inputs;
mod points;
mod run;
mod select;

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Instant;

use crate::build::{BuildFailure, Framework, HandInProgram, compile};
use crate::checks::{Bench, JudgedScene};
use crate::diagnosis::Catalogue;
use crate::error::Result;
use crate::host_process::HostProcess;
use crate::intake;
use crate::plan;
use crate::reference::Oracle;
use crate::replay::quote;
use crate::report::{
    CheckResult, Cost, LeftOut, Numerics, Points, Report, SCHEMA, Sandbox, SubmissionInfo, TaskResult,
};
use crate::rubric::Rubric;
use crate::sandbox::{Limits, Machine};
use crate::scan::scan;
use crate::statistics::sequential::{LOOKS, SCREENING_LEVEL};
use crate::submission::Submission;
use crate::text::clean;
use crate::trial;
use crate::workspace::Workspace;

use inputs::{hash_of_file, hash_of_references, load_scenes};
use select::select;

pub use inputs::load_scene;

/// What a grade is told beside the hand-in.
#[derive(Clone, Debug)]
pub struct Options {
    /// The assignment's name.
    pub assignment: String,
    /// The seed of all random numbers.
    pub seed: u64,
    /// Threads for the hand-in.
    pub threads: usize,
    /// Checks to run: by the name of the check, its kind, its scene, its technique or its task. All if empty.
    pub only: Vec<String>,
    /// What the hand-in may use up.
    pub limits: Limits,
}

/// Grades a hand-in. `on_check` is told of each check as it ends.
///
/// # Errors
/// What is not the hand-in's doing.
pub fn grade(
    workspace: &Workspace,
    submission: &Submission,
    options: &Options,
    on_check: impl FnMut(&CheckResult) + Send,
) -> Result<Report> {
    Grader::new(workspace, options)?.grade(submission, on_check)
}

/// All that is the same for every hand-in of an assignment, made ready once. It can grade several at a time.
pub struct Grader {
    options: Options,
    rubric: Rubric,
    scenes: BTreeMap<String, JudgedScene>,
    framework: Framework,
    framework_time: f64,
    oracle: Option<Oracle>,
    workspace: Workspace,
    /// What means nothing in its scenes, whatever the hand-in.
    left_out: Vec<LeftOut>,
    provenance: BTreeMap<String, String>,
    /// The mistakes that are known.
    catalogue: Catalogue,
}

impl Grader {
    /// Loads rubric, scenes and references, and builds the framework.
    ///
    /// # Errors
    /// If any of these is not as it should be.
    pub fn new(workspace: &Workspace, options: &Options) -> Result<Self> {
        let rubric_file = workspace.assignment(&options.assignment).join("rubric.yml");
        let rubric = Rubric::load(&rubric_file)?;
        let selected = select(&rubric, &options.only)?;
        let start = Instant::now();
        // The framework is mostly there already, and to find it does not take both cores.
        let (scenes, framework) = rayon::join(
            || load_scenes(workspace, &selected),
            || {
                let framework = Framework::build(workspace)?;
                trial::require_that_hand_ins_work(&framework, &options.limits)?;
                Ok::<_, crate::error::Error>(framework)
            },
        );
        let (scenes, framework) = (scenes?, framework?);
        let oracle = Oracle::of(workspace, &framework)?;
        let framework_time = start.elapsed().as_secs_f64();
        let left_out = plan::left_out(&scenes);
        let provenance = BTreeMap::from([
            ("grader".to_owned(), env!("CARGO_PKG_VERSION").to_owned()),
            ("framework".to_owned(), framework.hash.clone()),
            ("rubric".to_owned(), hash_of_file(&rubric_file)?),
            ("references".to_owned(), hash_of_references(&scenes)),
            ("seed".to_owned(), options.seed.to_string()),
            ("toolchain".to_owned(), framework.toolchain.clone()),
            ("threads".to_owned(), options.threads.to_string()),
        ]);
        Ok(Self {
            options: options.clone(),
            rubric,
            scenes,
            framework,
            framework_time,
            oracle,
            workspace: workspace.clone(),
            left_out,
            provenance,
            catalogue: Catalogue::load(&workspace.assignment(&options.assignment))?,
        })
    }

    /// What it was told.
    pub fn options(&self) -> &Options {
        &self.options
    }

    /// What hand-ins are linked against.
    pub fn framework(&self) -> &Framework {
        &self.framework
    }

    /// The solution, if the checkout has it.
    pub fn oracle(&self) -> Option<&Oracle> {
        self.oracle.as_ref()
    }

    /// What the assignment asks for.
    pub fn rubric(&self) -> &Rubric {
        &self.rubric
    }

    /// How many checks a grade runs at most.
    pub fn planned(&self) -> usize {
        select(&self.rubric, &self.options.only).map_or(0, |selected| selected.len())
    }

    /// What all grades rest on.
    pub fn provenance(&self) -> &BTreeMap<String, String> {
        &self.provenance
    }

    /// Grades a hand-in. `on_check` is told of each check as it ends.
    ///
    /// # Errors
    /// What is not the hand-in's doing.
    pub fn grade(
        &self,
        submission: &Submission,
        on_check: impl FnMut(&CheckResult) + Send,
    ) -> Result<Report> {
        Ok(self.judge(submission, None, on_check)?.0)
    }

    /// The same, and the program that was graded, unless it does not compile.
    ///
    /// # Errors
    /// What is not the hand-in's doing.
    pub fn grade_and_keep(
        &self,
        submission: &Submission,
        on_check: impl FnMut(&CheckResult) + Send,
    ) -> Result<(Report, Option<HandInProgram>)> {
        self.judge(submission, None, on_check)
    }

    /// The report on a hand-in in which there is nothing to grade: no points, and why.
    ///
    /// # Errors
    /// None that a hand-in could cause.
    pub fn refuse(&self, path: &Path, refusal: &intake::Refusal) -> Result<Report> {
        let nothing = Submission { path: path.to_owned(), source: String::new() };
        Ok(self.judge(&nothing, Some(refusal), |_| {})?.0)
    }

    fn judge(
        &self,
        submission: &Submission,
        refusal: Option<&intake::Refusal>,
        on_check: impl FnMut(&CheckResult) + Send,
    ) -> Result<(Report, Option<HandInProgram>)> {
        let start = Instant::now();
        let Self {
            options, rubric, scenes, framework, framework_time, oracle, workspace, provenance, ..
        } = self;
        let selected = select(rubric, &options.only)?;
        let build_start = Instant::now();
        let built = match refusal {
            None => compile(framework, &submission.source, &options.limits)?,
            Some(refusal) => Err(BuildFailure { messages: clean(&format!("{refusal}\n")), line: None }),
        };
        let build_time = build_start.elapsed().as_secs_f64();

        let run_start = Instant::now();
        let mut checks = Vec::new();
        let possible = Machine::here().layers();
        let mut sandbox = Sandbox::new(possible, possible, scan(&submission.source));
        let mut left_out = self.left_out.clone();
        if let Ok(program) = &built {
            let host = HostProcess::start(program, options.threads)?.layers();
            sandbox = Sandbox::new(program.layers, host, sandbox.findings);
            trial::require(&sandbox, options.limits.least)?;
            let path = quote(&submission.path);
            let Options { assignment, seed, threads, .. } = options;
            let bench = Bench {
                program,
                oracle: oracle.as_ref(),
                scenes,
                workspace,
                seed: *seed,
                screening_level: SCREENING_LEVEL / rubric.checks().count() as f64,
                threads: *threads,
                looks: LOOKS.len(),
                command: format!("cargo grade {path} --assignment={assignment} --seed={seed}"),
                path,
            };
            let mut meaningful = selected.clone();
            meaningful.retain(|(_, spec)| {
                let why = plan::why_left_out(spec, scenes.get(&spec.scene), oracle.is_some());
                let why_not = |why| LeftOut { check: spec.id(), scene: spec.scene.clone(), why };
                left_out.extend(why.clone().map(why_not));
                why.is_none()
            });
            checks = run::run(&bench, &meaningful, on_check)?;
        }
        let run_time = run_start.elapsed().as_secs_f64();
        let (program, build_failure) = match built {
            Ok(program) => (Some(program), None),
            Err(failure) => (None, Some(failure)),
        };
        let nothing_ran = build_failure.as_ref().map(|_| {
            if refusal.is_some() {
                "there is nothing that can be graded"
            } else {
                "the hand-in does not compile"
            }
        });
        let tasks: Vec<TaskResult> = rubric
            .tasks
            .iter()
            .map(|task| points::mark(task, &selected, &checks, &left_out, nothing_ran))
            .collect();
        let tasks = points::require(rubric, tasks, &checks);
        let total = |manual: bool| {
            let tasks = rubric.tasks.iter().filter(|task| task.manual == manual);
            // The library's own sum of nothing is −0.
            tasks.fold(0.0, |sum, task| sum + task.points)
        };
        let points = Points {
            earned: tasks.iter().filter_map(|task| task.points).fold(0.0, |sum, points| sum + points),
            automatic_max: total(false),
            manual_max: total(true),
            max: total(false) + total(true),
            marked: None,
            elsewhere: tasks.iter().map(|task| task.elsewhere).sum(),
        };
        let numerics = Numerics {
            non_finite: checks.iter().map(|check| check.non_finite).sum(),
            negative: checks.iter().map(|check| check.negative).sum(),
        };
        let mut report = Report {
            schema: SCHEMA.to_owned(),
            submission: SubmissionInfo {
                path: clean(&submission.path.display().to_string()),
                hash: submission.hash(),
                build_failure,
                explanations: Vec::new(),
                refusal: refusal.map(intake::Finding::from),
                notes: Vec::new(),
            },
            assignment: rubric.assignment.clone(),
            points,
            tasks,
            checks,
            left_out,
            diagnosis: Vec::new(),
            numerics,
            cost: Cost {
                framework: *framework_time,
                build: build_time,
                run: run_time,
                total: framework_time + start.elapsed().as_secs_f64(),
            },
            sandbox,
            provenance: provenance.clone(),
            convergence: None,
            images: Vec::new(),
        };
        report.diagnosis = self.catalogue.diagnose(&report, &submission.source);
        Ok((report, program))
    }
}
