//! Measuring the curves of several programs, which render in turns.

use std::path::Path;

use arty::integrator::{Settings, Technique};
use arty::sampler::batch_seed;
use arty::scene::{Scene, SceneDescription};

use super::curve_run::{CurveRun, ROUNDS};
use super::estimate::{PointEstimate, estimate, relative_bias_squared};
use super::summary::{efficiency, rounded, seconds_to, slope};
use crate::image_error::{Truth, relative_weight};
use crate::reference::{self, ReferenceView};
use harness::build::SubmissionProgram;
use harness::host_process::HostProcess;
use harness::job::apart;
use harness::workspace::Workspace;
use verdict::convergence::{Convergence, Curve, NotMeasured, Panel, Role};
use verdict::error::{Error, Result};
use verdict::rubric::{EmissionOnHit, View};

/// Options of a convergence measurement.
#[derive(Clone, Debug)]
pub struct Options {
    /// Names of the scenes.
    pub scenes: Vec<String>,
    /// Techniques of the submissions.
    pub techniques: Vec<Technique>,
    /// Processor time budget, in seconds.
    pub seconds: f64,
    /// Target relative MSE; by default that of the solution in renderings of middle length.
    pub target: Option<f64>,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Number of threads of each program.
    pub threads: usize,
    /// Number of rendering lengths.
    pub lengths: u32,
}

/// A program that is measured.
pub struct MeasuredProgram<'a> {
    /// Name in tables and plots.
    pub name: String,
    /// Role of the program; [`Role::Baseline`] renders with BSDF sampling only.
    pub role: Role,
    /// The program.
    pub program: &'a SubmissionProgram,
}

/// Measures all programs in all scenes. `on_round` is called with the fraction of the work that is done, in [0, 1].
///
/// # Errors
/// If the grader itself fails. A submission that crashes or exceeds its time limit has no curve, and is listed as not
/// measured.
pub fn measure(
    workspace: &Workspace,
    programs: &[MeasuredProgram<'_>],
    options: &Options,
    mut on_round: impl FnMut(f64),
) -> Result<Convergence> {
    let Options { threads, seconds, seed, .. } = *options;
    let mut convergence = Convergence { threads, seconds, seed, panels: Vec::new(), left_out: Vec::new() };
    let count = options.scenes.len();
    for (index, name) in options.scenes.iter().enumerate() {
        let scene = MeasuredScene::load(workspace, name)?;
        let share = options.seconds / count.max(1) as f64;
        let progress = |done: f64| on_round((index as f64 + done) / count as f64);
        measure_scene(&scene, programs, options, share, progress, &mut convergence)?;
    }
    Ok(convergence)
}

/// A scene with its reference image.
struct MeasuredScene {
    name: String,
    description: SceneDescription,
    max_bounces: u32,
    view: ReferenceView,
    area_lights: usize,
    point_lights: usize,
}

impl MeasuredScene {
    fn load(workspace: &Workspace, name: &str) -> Result<Self> {
        let description = arty::scene::file::load(&workspace.scene_file(name))?.description;
        let path = workspace.reference_file(name);
        let reference = reference::load(&path, name, &description)?;
        let (max_bounces, view) = full_view(reference, &path)?;
        let scene = Scene::new(&description);
        let (area_lights, point_lights) = (scene.features().area_lights, scene.features().point_lights);
        Ok(Self { name: name.to_owned(), description, max_bounces, view, area_lights, point_lights })
    }

    fn truth(&self) -> Truth<'_> {
        Truth { mean: &self.view.mean, variance: Some(&self.view.variance_of_mean) }
    }
}

/// The view with emission on hit and the largest number of bounces, and that number.
fn full_view(reference: reference::Reference, path: &Path) -> Result<(u32, ReferenceView)> {
    let all = |(view, image): (View, ReferenceView)| {
        (view.emission_on_hit == EmissionOnHit::On).then_some((view.max_bounces, image))
    };
    reference
        .views
        .into_iter()
        .rev()
        .find_map(all)
        .ok_or_else(|| Error::file(path, "the reference has no view with emission on hit"))
}

/// Measures all curves of one scene and adds its panels.
fn measure_scene(
    scene: &MeasuredScene,
    programs: &[MeasuredProgram<'_>],
    options: &Options,
    seconds: f64,
    mut on_round: impl FnMut(f64),
    into: &mut Convergence,
) -> Result<()> {
    let mut processes = Vec::new();
    for program in programs {
        let mut process = HostProcess::start(program.program, options.threads)?;
        let loaded = apart(process.load(&scene.description))?;
        processes.push((process, loaded));
    }
    let mut curve_runs = Vec::new();
    for (index, program) in programs.iter().enumerate() {
        let baseline = program.role == Role::Baseline;
        if baseline && scene.area_lights == 0 {
            into.left_out.push(NotMeasured {
                program: program.name.clone(),
                scene: scene.name.clone(),
                why: "no light has an area: BSDF sampling gives black".to_owned(),
            });
            continue;
        }
        let techniques = if baseline { &[Technique::Bsdf] } else { options.techniques.as_slice() };
        for &technique in techniques {
            let settings = Settings { technique, max_bounces: scene.max_bounces };
            let seed = batch_seed(options.seed, curve_runs.len() as u64);
            let fault = processes[index].1.as_ref().err().cloned();
            curve_runs.push(CurveRun {
                program: index,
                settings,
                seed,
                levels: Vec::new(),
                non_finite: 0,
                fault,
            });
        }
    }
    let share = seconds / curve_runs.len().max(1) as f64;
    for curve_run in &mut curve_runs {
        curve_run.plan(&mut processes[curve_run.program].0, share, options.lengths)?;
    }
    for round in 0..ROUNDS {
        for level in 0..options.lengths as usize {
            // Alternate the order, so that a machine that slows down favours no program.
            for place in 0..curve_runs.len() {
                let index = if round % 2 == 0 { place } else { curve_runs.len() - 1 - place };
                let curve_run = &mut curve_runs[index];
                curve_run.render(&mut processes[curve_run.program].0, level, round)?;
            }
            on_round(
                (round * options.lengths as usize + level + 1) as f64
                    / (ROUNDS * options.lengths as usize) as f64,
            );
        }
    }
    drop(processes);
    evaluate(scene, programs, options, curve_runs, into);
    Ok(())
}

/// A curve with the replicates that are needed to compare it with others.
struct MeasuredCurve {
    curve: Curve,
    levels: Vec<PointEstimate>,
}

fn evaluate(
    scene: &MeasuredScene,
    programs: &[MeasuredProgram<'_>],
    options: &Options,
    curve_runs: Vec<CurveRun>,
    into: &mut Convergence,
) {
    let truth = scene.truth();
    let mut measured = Vec::new();
    for mut curve_run in curve_runs {
        let MeasuredProgram { name, role, .. } = &programs[curve_run.program];
        if let Some(fault) = &curve_run.fault {
            into.left_out.push(NotMeasured {
                program: format!("{name}, {}", curve_run.settings.technique),
                scene: scene.name.clone(),
                why: fault.to_string(),
            });
            continue;
        }
        let renders = curve_run.finish();
        let levels: Vec<PointEstimate> =
            renders.iter().filter_map(|renders| estimate(renders, truth, options.seed)).collect();
        let bias = relative_bias_squared(&renders, truth, options.seed);
        let curve = Curve {
            name: match (*role, scene.point_lights) {
                // BSDF sampling cannot hit point lights, so that this curve flattens.
                (Role::Baseline, 1..) => format!("{name} (misses point lights)"),
                _ => name.clone(),
            },
            role: *role,
            technique: curve_run.settings.technique,
            points: levels.iter().map(|level| level.point.clone()).collect(),
            slope: slope(&levels),
            efficiency: None,
            seconds_to_target: None,
            relative_bias_squared: bias.map(|(estimate, _)| estimate),
            floor: bias.is_some_and(|(estimate, deviation)| estimate.value > 4.0 * deviation),
            non_finite: curve_run.non_finite,
        };
        measured.push(MeasuredCurve { curve, levels });
    }
    for &technique in &options.techniques {
        into.panels.push(panel(scene, technique, options.target, &measured));
    }
}

fn panel(
    scene: &MeasuredScene,
    technique: Technique,
    target: Option<f64>,
    measured: &[MeasuredCurve],
) -> Panel {
    let belongs = |measured: &&MeasuredCurve| {
        measured.curve.technique == technique || measured.curve.role == Role::Baseline
    };
    let shown: Vec<&MeasuredCurve> = measured.iter().filter(belongs).collect();
    let solution = shown.iter().find(|measured| measured.curve.role == Role::Solution);
    let middle = solution.or(shown.first()).map_or(0.0, |measured| {
        let points = &measured.curve.points;
        points.get(points.len() / 2).map_or(0.0, |point| point.relative_mse.value)
    });
    let target = target.unwrap_or_else(|| rounded(middle));
    let curve = |measured: &&MeasuredCurve| Curve {
        efficiency: solution.and_then(|solution| efficiency(&measured.levels, &solution.levels)),
        seconds_to_target: seconds_to(target, &measured.curve.points),
        ..measured.curve.clone()
    };
    let ReferenceView { mean, variance_of_mean, .. } = &scene.view;
    let noise = mean.iter().flatten().zip(variance_of_mean.iter().flatten());
    let noise = noise.map(|(&mean, variance)| relative_weight(mean) * variance).sum::<f64>();
    Panel {
        scene: scene.name.clone(),
        technique,
        max_bounces: scene.max_bounces,
        target,
        reference_noise: noise / (3 * mean.len()).max(1) as f64,
        curves: shown.iter().map(curve).collect(),
    }
}
