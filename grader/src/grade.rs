//! Grading one hand-in, from its file to its report.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Instant;

use arty::scene::Scene;

use crate::build::{BuildFailure, Framework, HandInProgram, compile, solution};
use crate::checks::{Bench, JudgedScene};
use crate::diagnosis::Catalogue;
use crate::error::{Error, Result};
use crate::host_process::HostProcess;
use crate::intake;
use crate::plan;
use crate::reference;
use crate::replay::quote;
use crate::report::{
    CheckResult, Cost, LeftOut, Numerics, Points, Reason, Report, SCHEMA, Sandbox, SubmissionInfo,
    TaskResult, Verdict,
};
use crate::rubric::{CheckKind, CheckSpec, Rubric, Task};
use crate::sandbox::{Limits, Machine};
use crate::scan::scan;
use crate::statistics::sequential::SCREENING_LEVEL;
use crate::submission::Submission;
use crate::text::clean;
use crate::trial;
use crate::workspace::Workspace;

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
    on_check: impl FnMut(&CheckResult),
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
    solution: Option<HandInProgram>,
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
        let scenes = load_scenes(workspace, &selected)?;
        let framework_start = Instant::now();
        let framework = Framework::build(workspace)?;
        let framework_time = framework_start.elapsed().as_secs_f64();
        trial::require_on_this_machine(&framework, &options.limits)?;
        let needed = selected.iter().any(|(_, spec)| spec.check == CheckKind::HiddenVariants);
        let solution = if needed { solution(workspace, &framework)? } else { None };
        let left_out = plan::left_out(&scenes);
        let provenance = BTreeMap::from([
            ("grader".to_owned(), env!("CARGO_PKG_VERSION").to_owned()),
            ("framework".to_owned(), framework.hash()?),
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
            solution,
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

    /// The solution, if a check needs it and the checkout has it.
    pub fn solution(&self) -> Option<&HandInProgram> {
        self.solution.as_ref()
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
    pub fn grade(&self, submission: &Submission, on_check: impl FnMut(&CheckResult)) -> Result<Report> {
        self.judge(submission, None, on_check)
    }

    /// The report on a hand-in in which there is nothing to grade: no points, and why.
    ///
    /// # Errors
    /// None that a hand-in could cause.
    pub fn refuse(&self, path: &Path, refusal: &intake::Refusal) -> Result<Report> {
        let nothing = Submission { path: path.to_owned(), source: String::new() };
        self.judge(&nothing, Some(refusal), |_| {})
    }

    fn judge(
        &self,
        submission: &Submission,
        refusal: Option<&intake::Refusal>,
        mut on_check: impl FnMut(&CheckResult),
    ) -> Result<Report> {
        let start = Instant::now();
        let Self {
            options, rubric, scenes, framework, framework_time, solution, workspace, provenance, ..
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
                solution: solution.as_ref(),
                scenes,
                workspace,
                seed: *seed,
                screening_level: SCREENING_LEVEL / rubric.checks().count() as f64,
                threads: *threads,
                command: format!("cargo grade {path} --assignment={assignment} --seed={seed}"),
                path,
            };
            for (task, spec) in &selected {
                if let Some(why) = plan::why_left_out(spec, scenes.get(&spec.scene), solution.is_some()) {
                    left_out.push(LeftOut { check: spec.id(), scene: spec.scene.clone(), why });
                    continue;
                }
                let out_of_time = out_of_time(&checks);
                let result = if out_of_time { bench.skip(task, spec) } else { bench.run(task, spec)? };
                on_check(&result);
                checks.push(result);
            }
        }
        let run_time = run_start.elapsed().as_secs_f64();
        let build_failure = built.err();
        let nothing_ran = build_failure.as_ref().map(|_| {
            if refusal.is_some() {
                "there is nothing that can be graded"
            } else {
                "the hand-in does not compile"
            }
        });
        let tasks: Vec<TaskResult> =
            rubric.tasks.iter().map(|task| mark(task, &selected, &checks, &left_out, nothing_ran)).collect();
        let tasks = require(rubric, tasks, &checks);
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
        Ok(report)
    }
}

/// True if no more checks are worth their time: one scene may be too much for a hand-in that is right in others, but
/// nobody waits for one that never ends.
fn out_of_time(checks: &[CheckResult]) -> bool {
    let late = |check: &CheckResult| check.reason == Reason::Timeout;
    let in_a_row = checks.iter().rev().take_while(|check| late(check)).count();
    in_a_row >= 2 || checks.iter().filter(|check| late(check)).count() >= 4
}

type Selected<'a> = Vec<(&'a Task, &'a CheckSpec)>;

/// The checks that `--only` names, in the order of the rubric: the cheapest and most telling stand first there.
fn select<'a>(rubric: &'a Rubric, only: &[String]) -> Result<Selected<'a>> {
    let names = |task: &Task, spec: &CheckSpec| {
        [
            spec.id(),
            spec.check.name().to_owned(),
            spec.scene.clone(),
            spec.technique.to_string(),
            task.id.clone(),
        ]
    };
    let selected: Selected<'a> = rubric
        .checks()
        .filter(|(task, spec)| only.is_empty() || names(task, spec).iter().any(|name| only.contains(name)))
        .collect();
    if selected.is_empty() {
        let all: Vec<String> = rubric.checks().map(|(_, spec)| spec.id()).collect();
        return Err(Error::Input(format!(
            "--only: no such check, scene or task; there are\n  {}",
            all.join("\n  ")
        )));
    }
    Ok(selected)
}

fn load_scenes(workspace: &Workspace, selected: &Selected<'_>) -> Result<BTreeMap<String, JudgedScene>> {
    let mut scenes = BTreeMap::new();
    for (_, spec) in selected.iter().filter(|(_, spec)| spec.check.needs_scene()) {
        if !scenes.contains_key(&spec.scene) {
            scenes.insert(spec.scene.clone(), load_scene(workspace, &spec.scene)?);
        }
    }
    Ok(scenes)
}

/// Loads a scene of the collection with its reference.
pub fn load_scene(workspace: &Workspace, name: &str) -> Result<JudgedScene> {
    let description = arty::scene::file::load(&workspace.scene_file(name))?.description;
    let reference = reference::load(&workspace.reference_file(name), name, &description)?;
    Ok(JudgedScene { scene: Scene::new(&description), description, reference })
}

/// The points of one task.
fn mark(
    task: &Task,
    selected: &Selected<'_>,
    results: &[CheckResult],
    left_out: &[LeftOut],
    nothing_ran: Option<&str>,
) -> TaskResult {
    let ids: Vec<String> = task.checks.iter().map(CheckSpec::id).collect();
    let mut result = TaskResult {
        id: task.id.clone(),
        title: task.title.clone(),
        points: None,
        max: task.points,
        elsewhere: 0.0,
        checks: ids,
        reason: String::new(),
    };
    if task.manual {
        result.reason = "marked by a person".to_owned();
        return result;
    }
    if let Some(why) = nothing_ran {
        result.points = Some(0.0);
        result.reason = why.to_owned();
        return result;
    }
    let was_selected =
        |spec: &CheckSpec| selected.iter().any(|(owner, other)| owner.id == task.id && *other == spec);
    if !task.checks.iter().all(was_selected) {
        result.reason = "not all of its checks were run".to_owned();
        return result;
    }
    let (mut earned, mut total, mut elsewhere) = (0.0, 0.0, 0.0);
    let mut missing_evidence = None;
    let mut missing = Vec::new();
    for spec in &task.checks {
        let id = spec.id();
        if left_out.iter().any(|left_out| left_out.check == id) {
            // A check that means nothing here is worth nothing; one that only staff can run keeps its worth.
            if plan::needs_solution(spec) {
                total += spec.weight;
                elsewhere += spec.weight;
            }
            continue;
        }
        total += spec.weight;
        let passed = results
            .iter()
            .any(|check| check.id == id && check.task == task.id && check.verdict == Verdict::Pass);
        if passed {
            earned += spec.weight;
        } else {
            missing.push(id.clone());
            if spec.evidence {
                missing_evidence.get_or_insert(id);
            }
        }
    }
    // Half points are the finest that a tutor would give.
    let points_of = |weight: f64| {
        let share = if total > 0.0 { weight / total } else { 0.0 };
        (task.points * share * 2.0).round() / 2.0
    };
    result.points = Some(points_of(earned));
    if elsewhere > 0.0 {
        result.elsewhere = task.points - points_of(total - elsewhere);
    }
    if let Some(id) = missing_evidence {
        result.points = Some(0.0);
        result.reason = format!("no points without {id}");
    } else if !missing.is_empty() {
        result.reason = missing.join(", ");
    }
    result
}

/// Takes the points of tasks that rest on other tasks' evidence where that is missing.
fn require(rubric: &Rubric, mut tasks: Vec<TaskResult>, results: &[CheckResult]) -> Vec<TaskResult> {
    for (task, result) in rubric.tasks.iter().zip(&mut tasks) {
        let lacks = |other: &&String| {
            results
                .iter()
                .any(|check| check.task == **other && check.evidence && check.verdict != Verdict::Pass)
        };
        if let (Some(points), Some(required)) = (result.points, task.requires.iter().find(lacks))
            && points > 0.0
        {
            result.points = Some(0.0);
            result.reason = format!("no points without {required}");
        }
    }
    tasks
}

fn hash_of_file(path: &Path) -> Result<String> {
    let text = std::fs::read_to_string(path).map_err(|error| Error::file(path, error))?;
    // Line by line, so that another system's line ends make no difference.
    let mut hasher = blake3::Hasher::new();
    text.lines().for_each(|line| {
        hasher.update(line.as_bytes()).update(b"\n");
    });
    Ok(hasher.finalize().to_hex().to_string())
}

fn hash_of_references(scenes: &BTreeMap<String, JudgedScene>) -> String {
    let mut hasher = blake3::Hasher::new();
    for (name, judged) in scenes {
        hasher.update(name.as_bytes());
        hasher.update(format!("{:?}", judged.reference).as_bytes());
    }
    hasher.finalize().to_hex().to_string()
}
