//! Grading one hand-in, from its file to its report.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Instant;

use arty::scene::Scene;

use crate::build::{Framework, HandInProgram, compile};
use crate::checks::{Bench, JudgedScene};
use crate::error::{Error, Result};
use crate::plan;
use crate::reference;
use crate::replay::quote;
use crate::report::{
    CheckResult, Cost, LeftOut, Numerics, Points, Reason, Report, SCHEMA, Sandbox, SubmissionInfo,
    TaskResult, Verdict,
};
use crate::rubric::{CheckSpec, Rubric, Task};
use crate::statistics::sequential::SCREENING_LEVEL;
use crate::submission::Submission;
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
}

/// Grades a hand-in. `on_check` is told of each check as it ends.
///
/// # Errors
/// What is not the hand-in's doing.
pub fn grade(
    workspace: &Workspace,
    submission: &Submission,
    options: &Options,
    mut on_check: impl FnMut(&CheckResult),
) -> Result<Report> {
    let start = Instant::now();
    let rubric_file = workspace.assignment(&options.assignment).join("rubric.yml");
    let rubric = Rubric::load(&rubric_file)?;
    let selected = select(&rubric, &options.only)?;
    let scenes = load_scenes(workspace, &selected)?;

    let framework_start = Instant::now();
    let framework = Framework::build(workspace)?;
    let framework_time = framework_start.elapsed().as_secs_f64();
    let build_start = Instant::now();
    let built = compile(&framework, &submission.source)?;
    let build_time = build_start.elapsed().as_secs_f64();

    let run_start = Instant::now();
    let mut checks = Vec::new();
    let mut left_out = plan::left_out(&rubric, |name| scenes.get(name));
    if let Ok(program) = &built {
        let bench = bench(workspace, program, &scenes, submission, options, rubric.checks().count());
        for (task, spec) in &selected {
            let judged = scenes.get(&spec.scene);
            if let Some(why) = judged.and_then(|judged| plan::why_left_out(spec, judged)) {
                left_out.push(LeftOut { check: spec.id(), scene: spec.scene.clone(), why });
                continue;
            }
            let out_of_time = checks.iter().any(|check: &CheckResult| check.reason == Reason::Timeout);
            let result = if out_of_time { bench.skip(task, spec) } else { bench.run(task, spec)? };
            on_check(&result);
            checks.push(result);
        }
    }
    let run_time = run_start.elapsed().as_secs_f64();
    let build_failure = built.err();
    let tasks: Vec<TaskResult> = rubric
        .tasks
        .iter()
        .map(|task| mark(task, &selected, &checks, &left_out, build_failure.is_some()))
        .collect();
    let total =
        |manual: bool| rubric.tasks.iter().filter(|task| task.manual == manual).map(|task| task.points).sum();
    let points = Points {
        earned: tasks.iter().filter_map(|task| task.points).fold(0.0, |sum, points| sum + points),
        automatic_max: total(false),
        manual_max: total(true),
        max: total(false) + total(true),
    };
    let numerics = Numerics {
        non_finite: checks.iter().map(|check| check.non_finite).sum(),
        negative: checks.iter().map(|check| check.negative).sum(),
    };
    let provenance = BTreeMap::from([
        ("grader".to_owned(), env!("CARGO_PKG_VERSION").to_owned()),
        ("framework".to_owned(), framework.hash()?),
        ("rubric".to_owned(), hash_of_file(&rubric_file)?),
        ("references".to_owned(), hash_of_references(&scenes)),
        ("seed".to_owned(), options.seed.to_string()),
        ("toolchain".to_owned(), framework.toolchain.clone()),
        ("threads".to_owned(), options.threads.to_string()),
    ]);
    Ok(Report {
        schema: SCHEMA.to_owned(),
        submission: SubmissionInfo {
            path: submission.path.display().to_string(),
            hash: submission.hash(),
            build_failure,
        },
        assignment: rubric.assignment.clone(),
        points,
        tasks,
        checks,
        left_out,
        diagnosis: Vec::new(),
        numerics,
        cost: Cost {
            framework: framework_time,
            build: build_time,
            run: run_time,
            total: start.elapsed().as_secs_f64(),
        },
        sandbox: Sandbox { level: "none".to_owned() },
        provenance,
    })
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
            let description = arty::scene::file::load(&workspace.scene_file(&spec.scene))?.description;
            let reference =
                reference::load(&workspace.reference_file(&spec.scene), &spec.scene, &description)?;
            let scene = Scene::new(&description);
            scenes.insert(spec.scene.clone(), JudgedScene { description, scene, reference });
        }
    }
    Ok(scenes)
}

fn bench<'a>(
    workspace: &'a Workspace,
    program: &'a HandInProgram,
    scenes: &'a BTreeMap<String, JudgedScene>,
    submission: &Submission,
    options: &Options,
    checks: usize,
) -> Bench<'a> {
    let Options { assignment, seed, .. } = options;
    let path = quote(&submission.path);
    Bench {
        program,
        scenes,
        workspace,
        seed: *seed,
        screening_level: SCREENING_LEVEL / checks as f64,
        threads: options.threads,
        command: format!("cargo grade {path} --assignment={assignment} --seed={seed}"),
        path,
    }
}

/// The points of one task.
fn mark(
    task: &Task,
    selected: &Selected<'_>,
    results: &[CheckResult],
    left_out: &[LeftOut],
    build_failed: bool,
) -> TaskResult {
    let ids: Vec<String> = task.checks.iter().map(CheckSpec::id).collect();
    let mut result = TaskResult {
        id: task.id.clone(),
        title: task.title.clone(),
        points: None,
        max: task.points,
        checks: ids,
        reason: String::new(),
    };
    if task.manual {
        result.reason = "marked by a person".to_owned();
        return result;
    }
    if build_failed {
        result.points = Some(0.0);
        result.reason = "the hand-in does not compile".to_owned();
        return result;
    }
    let was_selected =
        |spec: &CheckSpec| selected.iter().any(|(owner, other)| owner.id == task.id && *other == spec);
    if !task.checks.iter().all(was_selected) {
        result.reason = "not all of its checks were run".to_owned();
        return result;
    }
    let (mut earned, mut total) = (0.0, 0.0);
    let mut missing_evidence = None;
    let mut missing = Vec::new();
    for spec in &task.checks {
        let id = spec.id();
        if left_out.iter().any(|left_out| left_out.check == id) {
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
    let share = if total > 0.0 { earned / total } else { 0.0 };
    result.points = Some((task.points * share * 2.0).round() / 2.0);
    if let Some(id) = missing_evidence {
        result.points = Some(0.0);
        result.reason = format!("no points without {id}");
    } else if !missing.is_empty() {
        result.reason = missing.join(", ");
    }
    result
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
