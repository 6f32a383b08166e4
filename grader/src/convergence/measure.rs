//! Having programs render, in turns.

use std::path::Path;

use arty::integrator::{Settings, Technique};
use arty::sampler::batch_seed;
use arty::scene::{Scene, SceneDescription};
use host::protocol::{RenderJob, Switches};

use super::estimate::{Estimated, Renders, estimate, relative_bias_squared};
use super::summary::{efficiency, rounded, seconds_to, slope};
use super::{Convergence, Curve, Panel, Role};
use crate::build::HandInProgram;
use crate::error::{Error, Result};
use crate::host_process::{Fault, HostProcess};
use crate::image_error::{Truth, relative_weight};
use crate::reference::{self, Light, SIZE};
use crate::report::LeftOut;
use crate::rubric::{Hits, View};
use crate::workspace::Workspace;

/// What is measured.
#[derive(Clone, Debug)]
pub struct Options {
    /// Scenes by name.
    pub scenes: Vec<String>,
    /// Techniques of the hand-ins.
    pub techniques: Vec<Technique>,
    /// Processor time for all of it, in seconds.
    pub seconds: f64,
    /// The relative MSE to which times are taken; by default what the solution has in renderings of middle length.
    pub target: Option<f64>,
    /// The seed of all random numbers.
    pub seed: u64,
    /// Threads of each program.
    pub threads: usize,
    /// How many lengths of renderings.
    pub lengths: u32,
}

/// A program that takes part.
pub struct Contestant<'a> {
    /// What it is called.
    pub name: String,
    /// Whose it is; [`Role::Baseline`] renders with plain BSDF sampling only.
    pub role: Role,
    /// The program.
    pub program: &'a HandInProgram,
}

/// Measures all programs in all scenes. `on_round` is told how much of the work is done, in [0, 1].
///
/// # Errors
/// What is not a hand-in's doing. Of a hand-in that crashes or takes too long there is no curve, and the reason why.
pub fn measure(
    workspace: &Workspace,
    contestants: &[Contestant<'_>],
    options: &Options,
    mut on_round: impl FnMut(f64),
) -> Result<Convergence> {
    let Options { threads, seconds, seed, .. } = *options;
    let mut convergence = Convergence { threads, seconds, seed, panels: Vec::new(), left_out: Vec::new() };
    let count = options.scenes.len();
    for (index, name) in options.scenes.iter().enumerate() {
        let scene = ScenePlan::load(workspace, name)?;
        let share = options.seconds / count.max(1) as f64;
        let progress = |done: f64| on_round((index as f64 + done) / count as f64);
        race(&scene, contestants, options, share, progress, &mut convergence)?;
    }
    Ok(convergence)
}

/// A scene, and what it looks like.
struct ScenePlan {
    name: String,
    description: SceneDescription,
    max_bounces: u32,
    light: Light,
    area_lights: usize,
    point_lights: usize,
}

impl ScenePlan {
    fn load(workspace: &Workspace, name: &str) -> Result<Self> {
        let description = arty::scene::file::load(&workspace.scene_file(name))?.description;
        let path = workspace.reference_file(name);
        let reference = reference::load(&path, name, &description)?;
        let (max_bounces, light) = full_light(reference, &path)?;
        let scene = Scene::new(&description);
        let (area_lights, point_lights) = (scene.features().area_lights, scene.features().point_lights);
        Ok(Self { name: name.to_owned(), description, max_bounces, light, area_lights, point_lights })
    }

    fn truth(&self) -> Truth<'_> {
        Truth { mean: &self.light.mean, variance: Some(&self.light.variance_of_mean) }
    }
}

/// The image with all light, at the largest number of bounces.
fn full_light(reference: reference::Reference, path: &Path) -> Result<(u32, Light)> {
    let all = |(view, light): (View, Light)| (view.hits == Hits::On).then_some((view.max_bounces, light));
    reference
        .views
        .into_iter()
        .rev()
        .find_map(all)
        .ok_or_else(|| Error::file(path, "there is no image with all light in it"))
}

/// One curve while it is measured.
struct Racer {
    contestant: usize,
    settings: Settings,
    seed: u64,
    levels: Vec<Level>,
    non_finite: u64,
    fault: Option<Fault>,
}

/// Renderings of one length.
#[derive(Default)]
struct Level {
    wanted: usize,
    renders: Renders,
    /// Processor time of one rendering, job by job.
    times: Vec<f64>,
}

/// Turns that the renderings of each length are divided into.
const ROUNDS: usize = 3;

/// Measures all curves of one scene and adds its panels.
fn race(
    scene: &ScenePlan,
    contestants: &[Contestant<'_>],
    options: &Options,
    seconds: f64,
    mut on_round: impl FnMut(f64),
    into: &mut Convergence,
) -> Result<()> {
    let mut processes = Vec::new();
    for contestant in contestants {
        let mut process = HostProcess::start(contestant.program, options.threads)?;
        let loaded = process.load(&scene.description)?;
        processes.push((process, loaded));
    }
    let mut racers = Vec::new();
    for (index, contestant) in contestants.iter().enumerate() {
        let baseline = contestant.role == Role::Baseline;
        if baseline && scene.area_lights == 0 {
            into.left_out.push(LeftOut {
                check: format!("convergence of {}", contestant.name),
                scene: scene.name.clone(),
                why: "no light has an area: BSDF sampling gives black".to_owned(),
            });
            continue;
        }
        let techniques = if baseline { &[Technique::Bsdf] } else { options.techniques.as_slice() };
        for &technique in techniques {
            let settings = Settings { technique, max_bounces: scene.max_bounces };
            let seed = batch_seed(options.seed, racers.len() as u64);
            let fault = processes[index].1.as_ref().err().cloned();
            racers.push(Racer {
                contestant: index,
                settings,
                seed,
                levels: Vec::new(),
                non_finite: 0,
                fault,
            });
        }
    }
    let share = seconds / racers.len().max(1) as f64;
    for racer in &mut racers {
        racer.plan(&mut processes[racer.contestant].0, share, options.lengths)?;
    }
    for round in 0..ROUNDS {
        for level in 0..options.lengths as usize {
            // Forwards and backwards in turn, so that a machine that slows down favours nobody.
            for place in 0..racers.len() {
                let index = if round % 2 == 0 { place } else { racers.len() - 1 - place };
                let racer = &mut racers[index];
                racer.render(&mut processes[racer.contestant].0, level, round)?;
            }
            on_round(
                (round * options.lengths as usize + level + 1) as f64
                    / (ROUNDS * options.lengths as usize) as f64,
            );
        }
    }
    drop(processes);
    evaluate(scene, contestants, options, racers, into);
    Ok(())
}

/// Renderings of the greatest length, and the most of any.
const RENDERS: (usize, usize) = (6, 48);

/// Of each length so many times as many renderings as of the next longer one.
const MORE_OF_SHORTER: f64 = 1.5;

/// A rendering takes at most this long and, the shortest ones, hardly less than that, in seconds.
const RENDER_TIME: (f64, f64) = (0.3e-3, 5.0);

/// Each length is at most so many times the next shorter one.
const LARGEST_STEP: f64 = 4.0;

impl Racer {
    /// Warms up, sees how fast it goes, and plans renderings that take the given processor time altogether.
    fn plan(&mut self, process: &mut HostProcess, seconds: f64, lengths: u32) -> Result<()> {
        let mut samples = 1;
        let per_sample = loop {
            // What is rendered here is left out.
            let Some((_, time)) = self.job(process, samples, &[batch_seed(self.seed, u64::MAX)])? else {
                return Ok(());
            };
            if time > (0.03 * seconds).min(0.02) || samples >= 1 << 20 {
                break time / samples as f64;
            }
            samples *= 2;
        };
        let last = f64::from(lengths.max(2) - 1);
        let shortest = (RENDER_TIME.0 / per_sample).max(1.0);
        let plan = |longest: f64| -> Vec<Level> {
            let step = (longest / shortest).powf(1.0 / last).clamp(1.0, LARGEST_STEP);
            let level = |k: u32| {
                let samples = (longest / step.powf(last - f64::from(k))).round().max(1.0) as u64;
                let more = MORE_OF_SHORTER.powi((lengths - 1 - k) as i32);
                let wanted = ((RENDERS.0 as f64 * more) as usize).min(RENDERS.1);
                Level { wanted, renders: Renders { samples, ..Renders::default() }, times: Vec::new() }
            };
            let mut levels: Vec<Level> = (0..lengths).map(level).collect();
            levels.dedup_by_key(|level| level.renders.samples);
            levels
        };
        let takes = |levels: &[Level]| -> f64 {
            levels.iter().map(|level| level.wanted as f64 * level.renders.samples as f64 * per_sample).sum()
        };
        let mut longest = (seconds / RENDERS.0 as f64).min(RENDER_TIME.1) / per_sample;
        while longest > 1.0 && takes(&plan(longest)) > seconds {
            longest *= 0.95;
        }
        self.levels = plan(longest.max(1.0));
        Ok(())
    }

    /// One turn of one length.
    fn render(&mut self, process: &mut HostProcess, level: usize, round: usize) -> Result<()> {
        let Some(Level { wanted, renders, .. }) = self.levels.get(level) else { return Ok(()) };
        let (samples, first) = (renders.samples, renders.images.len());
        let until = wanted * (round + 1) / ROUNDS;
        let seeds: Vec<u64> = (first..until)
            .map(|index| batch_seed(batch_seed(self.seed, level as u64), index as u64))
            .collect();
        if seeds.is_empty() {
            return Ok(());
        }
        if let Some((images, seconds)) = self.job(process, samples, &seeds)? {
            self.levels[level].renders.images.extend(images);
            self.levels[level].times.push(seconds / seeds.len() as f64);
        }
        Ok(())
    }

    /// Renderings and the processor time of all of them; `None` once the program has failed.
    fn job(&mut self, process: &mut HostProcess, samples: u64, seeds: &[u64]) -> Result<Option<Rendered>> {
        if self.fault.is_some() {
            return Ok(None);
        }
        let job = RenderJob {
            scene: 0,
            settings: self.settings,
            width: SIZE.0,
            height: SIZE.1,
            seeds: seeds.to_vec(),
            first_sample: 0,
            samples,
            switches: Switches::default(),
        };
        match process.render(&job)? {
            Ok(rendered) => {
                self.non_finite += rendered.non_finite;
                let pixels =
                    |batch: Vec<[f32; 3]>| batch.into_iter().map(|pixel| pixel.map(f64::from)).collect();
                let images = rendered.batches.into_iter().map(pixels).collect();
                // A clock too coarse to see anything must not make time stand still.
                Ok(Some((images, rendered.cpu_seconds.max(1e-9))))
            }
            Err(fault) => {
                self.fault = Some(fault);
                Ok(None)
            }
        }
    }

    /// What was rendered, from the shortest to the longest.
    fn finish(&mut self) -> Vec<Renders> {
        let levels = std::mem::take(&mut self.levels).into_iter();
        let renders = levels.map(|mut level| {
            // The median over the jobs: one that something else got in the way of does not count.
            level.times.sort_unstable_by(f64::total_cmp);
            level.renders.seconds = level.times.get(level.times.len() / 2).copied().unwrap_or(0.0);
            level.renders
        });
        renders.collect()
    }
}

type Rendered = (Vec<Vec<[f64; 3]>>, f64);

/// A curve with all that is needed to compare it with others.
struct Measured {
    curve: Curve,
    levels: Vec<Estimated>,
}

fn evaluate(
    scene: &ScenePlan,
    contestants: &[Contestant<'_>],
    options: &Options,
    racers: Vec<Racer>,
    into: &mut Convergence,
) {
    let truth = scene.truth();
    let mut measured = Vec::new();
    for mut racer in racers {
        let Contestant { name, role, .. } = &contestants[racer.contestant];
        if let Some(fault) = &racer.fault {
            into.left_out.push(LeftOut {
                check: format!("convergence of {name}, {}", racer.settings.technique),
                scene: scene.name.clone(),
                why: fault.to_string(),
            });
            continue;
        }
        let renders = racer.finish();
        let levels: Vec<Estimated> =
            renders.iter().filter_map(|renders| estimate(renders, truth, options.seed)).collect();
        let bias = relative_bias_squared(&renders, truth, options.seed);
        let curve = Curve {
            name: match (*role, scene.point_lights) {
                // No path hits them by chance, so that this curve must flatten.
                (Role::Baseline, 1..) => format!("{name} (misses point lights)"),
                _ => name.clone(),
            },
            role: *role,
            technique: racer.settings.technique,
            points: levels.iter().map(|level| level.point.clone()).collect(),
            slope: slope(&levels),
            efficiency: None,
            seconds_to_target: None,
            relative_bias_squared: bias.map(|(estimate, _)| estimate),
            floor: bias.is_some_and(|(estimate, deviation)| estimate.value > 4.0 * deviation),
            non_finite: racer.non_finite,
        };
        measured.push(Measured { curve, levels });
    }
    for &technique in &options.techniques {
        into.panels.push(panel(scene, technique, options.target, &measured));
    }
}

fn panel(scene: &ScenePlan, technique: Technique, target: Option<f64>, measured: &[Measured]) -> Panel {
    let belongs =
        |measured: &&Measured| measured.curve.technique == technique || measured.curve.role == Role::Baseline;
    let shown: Vec<&Measured> = measured.iter().filter(belongs).collect();
    let solution = shown.iter().find(|measured| measured.curve.role == Role::Solution);
    let middle = solution.or(shown.first()).map_or(0.0, |measured| {
        let points = &measured.curve.points;
        points.get(points.len() / 2).map_or(0.0, |point| point.relative_mse.value)
    });
    let target = target.unwrap_or_else(|| rounded(middle));
    let curve = |measured: &&Measured| Curve {
        efficiency: solution.and_then(|solution| efficiency(&measured.levels, &solution.levels)),
        seconds_to_target: seconds_to(target, &measured.curve.points),
        ..measured.curve.clone()
    };
    let Light { mean, variance_of_mean, .. } = &scene.light;
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
