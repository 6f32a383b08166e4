//! Runs of the audit.

use arty::probe::{self, Counts, Key, ScriptedSampling, ScriptedValue, take_counts};
use arty::ray::Ray;
use arty::sampler::Sampler;
use arty::scene::Scene;

use crate::protocol::{AuditJob, AuditRun, AuditSampling, AuditScene, AuditedRun};
use crate::submission::Submission;

/// All runs of a valid job.
pub(crate) fn all(key: &Key, submission: Submission, job: &AuditJob) -> Vec<AuditedRun> {
    let scenes: Vec<Scene> = job.scenes.iter().map(build).collect();
    let mut black_when_hit: Vec<Scene> = job.scenes.iter().map(build).collect();
    black_when_hit.iter_mut().for_each(Scene::blacken_hits);
    let runs = job.runs.iter().map(|audited| {
        let scripted = &job.scenes[audited.scene as usize];
        let built = if audited.emission_on_hit { &scenes } else { &black_when_hit };
        let scene = &built[audited.scene as usize];
        let ray = Ray::new(scripted.origin, scripted.direction);
        let result = run(key, submission, audited, scene, ray);
        probe::set_strata(key, None);
        result
    });
    runs.collect()
}

fn run(key: &Key, submission: Submission, run: &AuditRun, scene: &Scene, ray: Ray) -> AuditedRun {
    let integrator = (submission.path_tracer)(run.settings, scene);
    let count = f64::from(run.paths);
    let mut values = Vec::with_capacity(run.paths as usize);
    let (mut rays, mut light_samples) = ([u32::MAX, 0], [u32::MAX, 0]);
    let include = |[min, max]: [u32; 2], value: u32| [min.min(value), max.max(value)];
    for path in 0..run.paths {
        let with_extreme = run.with_extreme;
        let strata = probe::Strata { path, count: run.paths, seed: run.seed, with_extreme };
        probe::set_strata(key, Some(strata));
        take_counts(key);
        values.push(integrator.radiance(
            scene,
            ray,
            &mut Sampler::new(u64::from(run.seed), (0, 0), u64::from(path)),
        ));
        let counts: Counts = take_counts(key);
        rays = include(rays, counts.rays + counts.shadow_rays);
        light_samples = include(light_samples, counts.light_samples);
    }
    let channels = || values.iter().map(|value| value.to_array().map(f64::from));
    let mut mean = [0.0; 3];
    let mut spread = [0.0; 3];
    for channel in 0..3 {
        mean[channel] = channels().map(|value| value[channel]).sum::<f64>() / count;
        let squares = channels().map(|value| (value[channel] - mean[channel]).powi(2));
        spread[channel] = (squares.sum::<f64>() / count).sqrt();
    }
    AuditedRun { mean, spread, rays, light_samples }
}

fn build(scripted: &AuditScene) -> Scene {
    let mut scene = Scene::new(&scripted.scene);
    let bsdfs: Vec<_> = scripted
        .bsdfs
        .iter()
        .map(|bsdf| {
            bsdf.map(|it| {
                let is_delta = it.sampling == AuditSampling::Delta;
                let (f, pdf) = if is_delta { it.at_target } else { it.elsewhere };
                probe::ScriptedBsdf {
                    target: it.target,
                    f,
                    pdf,
                    is_delta,
                    at_target: Some(ScriptedValue { f: it.at_target.0, pdf: it.at_target.1 }),
                    at_viewer: Some(ScriptedValue { f: it.at_viewer.0, pdf: it.at_viewer.1 }),
                    sampling: match it.sampling {
                        AuditSampling::Target | AuditSampling::Delta => ScriptedSampling::Target,
                        AuditSampling::DeltaLobe => ScriptedSampling::DeltaLobe,
                        AuditSampling::Nothing => ScriptedSampling::Nothing,
                    },
                }
            })
        })
        .collect();
    let light = |it: crate::protocol::AuditLight| probe::ScriptedLight {
        point: it.point,
        pdf_area: it.pdf_area,
        pdf_area_on_hit: it.pdf_area_on_hit,
        bright_from: it.bright_from,
    };
    let lights: Vec<_> = scripted.lights.iter().map(|it| it.map(light)).collect();
    scene.set_script(&bsdfs, &lights);
    scene
}
