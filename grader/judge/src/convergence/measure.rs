//! Measuring the curves of several programs, which render in turns.

use std::path::Path;

use arty::integrator::{Settings, Technique};
use arty::sampler::batch_seed;
use arty::scene::{Scene, SceneDescription};

use super::bias::{self, looks};
use super::curve_run::CurveRun;
use super::panel::{MeasuredCurve, panel};
use super::plan::blocks;
use crate::image_error::Truth;
use crate::reference::{self, ReferenceView};
use harness::build::SubmissionProgram;
use harness::host_process::HostProcess;
use harness::job::apart;
use harness::workspace::Workspace;
use verdict::convergence::{Bias, Convergence, NotMeasured, Role};
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
    /// Target relative MSE; by default that of the yardstick in renderings of middle length.
    pub target: Option<f64>,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Number of threads of each program.
    pub threads: usize,
    /// Number of rendering lengths.
    pub lengths: u32,
    /// True if the means are tested for bias, which takes up to half as much time again.
    pub bias: bool,
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
            curve_runs.push(CurveRun::new(index, settings, seed, fault));
        }
    }
    let share = seconds / curve_runs.len().max(1) as f64;
    let blocks = blocks(share);
    for curve_run in &mut curve_runs {
        let process = &mut processes[curve_run.program].0;
        curve_run.plan(process, share / blocks as f64, options.lengths)?;
    }
    for block in 0..blocks {
        for level in 0..options.lengths as usize {
            // Alternate the order, so that a machine that slows down favours no program.
            for place in 0..curve_runs.len() {
                let index = if (block + level) % 2 == 0 { place } else { curve_runs.len() - 1 - place };
                let curve_run = &mut curve_runs[index];
                curve_run.render(&mut processes[curve_run.program].0, level, block, scene.truth())?;
            }
        }
        on_round((block + 1) as f64 / blocks as f64);
    }
    let mut measured = Vec::new();
    for mut curve_run in curve_runs {
        let process = &mut processes[curve_run.program].0;
        let bias =
            if options.bias { scene.bias(&mut curve_run, process, 0.5 * share)? } else { Bias::NotTested };
        measured.extend(scene.curve(programs, options, curve_run, bias, into));
    }
    for &technique in &options.techniques {
        let settings = (technique, scene.max_bounces);
        into.panels.push(panel(scene.name.clone(), settings, &scene.view, options.target, &measured));
    }
    Ok(())
}

impl MeasuredScene {
    /// Tests a curve for bias, in about this processor time if none is suspected.
    fn bias(&self, curve_run: &mut CurveRun, process: &mut HostProcess, seconds: f64) -> Result<Bias> {
        let expected = self.view.expected(curve_run.settings.technique);
        let squared = curve_run.bias_squared.relative(self.truth());
        let (Some(expected), Some(squared), None) = (expected, squared, &curve_run.fault) else {
            return Ok(Bias::NotTested);
        };
        let looks = looks(seconds, curve_run.per_sample);
        match apart(bias::test(process, &expected, curve_run.settings, curve_run.seed, looks, squared))? {
            Ok(bias) => Ok(bias),
            Err(fault) => {
                curve_run.fault = Some(fault);
                Ok(Bias::NotTested)
            }
        }
    }

    /// The curve of a run; `None`, and listed as not measured, if the program failed.
    fn curve(
        &self,
        programs: &[MeasuredProgram<'_>],
        options: &Options,
        curve_run: CurveRun,
        bias: Bias,
        into: &mut Convergence,
    ) -> Option<MeasuredCurve> {
        let MeasuredProgram { name, role, .. } = &programs[curve_run.program];
        let technique = curve_run.settings.technique;
        if let Some(fault) = &curve_run.fault {
            let several = options.techniques.len() > 1 && *role != Role::Baseline;
            into.left_out.push(NotMeasured {
                program: if several { format!("{name}, {technique}") } else { name.clone() },
                scene: self.name.clone(),
                why: fault.to_string(),
            });
            return None;
        }
        let name = match (*role, self.point_lights) {
            // BSDF sampling cannot hit point lights, so that this curve flattens.
            (Role::Baseline, 1..) => format!("{name} (misses point lights)"),
            _ => name.clone(),
        };
        Some(MeasuredCurve::new(name, (*role, technique), curve_run.tally, bias, curve_run.non_finite))
    }
}
