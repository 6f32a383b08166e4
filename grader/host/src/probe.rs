//! Tracing paths through scripted scenes.

use arty::integrator::Integrator;
use arty::math::Rgb;
use arty::probe::{self, Key, take_counts};
use arty::ray::Ray;
use arty::sampler::Sampler;
use arty::scene::Scene;

use crate::protocol::{ProbeJob, ProbedPath, ScriptedScene};
use crate::submission::Submission;

/// All paths of a job, by scene.
pub(crate) fn all(key: &Key, submission: Submission, job: &ProbeJob) -> Vec<Vec<ProbedPath>> {
    job.scenes
        .iter()
        .map(|scripted| {
            let scene = build(scripted);
            let integrator = (submission.path_tracer)(job.settings, &scene);
            let ray = Ray::new(scripted.origin, scripted.direction);
            let paths = (0..job.samples).map(|sample| {
                probe::set_strata(key, job.stratified.then(|| strata(job, sample)));
                path(key, &*integrator, &scene, ray, job.seed, sample)
            });
            let paths = paths.collect();
            probe::set_strata(key, None);
            paths
        })
        .collect()
}

fn strata(job: &ProbeJob, sample: u64) -> probe::Strata {
    probe::Strata {
        path: sample as u32,
        count: job.samples as u32,
        seed: job.seed as u32,
        with_extreme: false,
    }
}

fn path(
    key: &Key,
    integrator: &dyn Integrator,
    scene: &Scene,
    ray: Ray,
    seed: u64,
    sample: u64,
) -> ProbedPath {
    take_counts(key);
    let radiance = integrator.radiance(scene, ray, &mut Sampler::new(seed, (0, 0), sample)).to_array();
    let probe::Counts { rays, shadow_rays, light_samples } = take_counts(key);
    ProbedPath { radiance, rays, shadow_rays, light_samples }
}

fn build(scripted: &ScriptedScene) -> Scene {
    let mut scene = Scene::new(&scripted.scene);
    let bsdfs: Vec<_> = scripted
        .bsdfs
        .iter()
        .map(|bsdf| {
            bsdf.map(|it| {
                let value = |pdf| probe::ScriptedValue { f: Rgb::gray(it.f), pdf };
                probe::ScriptedBsdf {
                    target: it.target,
                    f: Rgb::gray(it.f),
                    pdf: it.pdf_elsewhere,
                    is_delta: it.is_delta,
                    at_target: Some(value(it.pdf)),
                    at_viewer: Some(value(it.pdf_at_viewer)),
                    sampling: probe::ScriptedSampling::Target,
                }
            })
        })
        .collect();
    let lights: Vec<_> = scripted
        .lights
        .iter()
        .map(|light| {
            light.map(|it| probe::ScriptedLight {
                point: it.point,
                pdf_area: it.pdf_area,
                pdf_area_on_hit: it.pdf_area_on_hit,
                bright_from: None,
            })
        })
        .collect();
    scene.set_script(&bsdfs, &lights);
    scene
}
