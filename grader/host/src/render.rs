//! Rendering the batches of a job.

use std::sync::atomic::AtomicBool;

use arty::film::{Anomaly, Film};
use arty::probe::{Key, take_counts};
use arty::render::render;
use arty::sampler::Streams;
use arty::scene::Scene;
use cpu_time::ProcessTime;
use rayon::iter::{IntoParallelRefIterator, ParallelIterator};

use crate::protocol::{AnomalousSample, RenderJob, Rendered};
use crate::submission::Submission;

/// Maximum number of anomalous samples in a response.
const MAX_ANOMALIES: usize = 16;

/// Renders the batches in parallel, each with its own seed and all with one path tracer, and counts their rays.
pub(crate) fn batches(key: &Key, submission: Submission, scene: &Scene, job: &RenderJob) -> Rendered {
    let integrator = (submission.path_tracer)(job.settings, scene);
    take_rays(key);
    let start = ProcessTime::now();
    let films: Vec<(u64, Film)> = job
        .seeds
        .par_iter()
        .map(|&seed| {
            let mut film = Film::new(job.width, job.height);
            render(
                &*integrator,
                scene,
                &mut film,
                job.first_sample..job.first_sample.saturating_add(job.samples),
                Streams::independent(seed),
                &AtomicBool::new(false),
            );
            (seed, film)
        })
        .collect();
    let mut rendered = Rendered {
        batches: Vec::with_capacity(films.len()),
        non_finite: 0,
        negative: 0,
        first_anomalies: Vec::new(),
        rays: take_rays(key),
        cpu_seconds: start.elapsed().as_secs_f64(),
    };
    for (seed, film) in films {
        rendered.batches.push(film.pixels().iter().map(|pixel| pixel.mean().to_array()).collect());
        let anomalies = film.anomalies();
        rendered.non_finite += anomalies.non_finite;
        rendered.negative += anomalies.negative;
        let named = |&Anomaly { x, y, sample, value, .. }: &Anomaly| AnomalousSample {
            seed,
            x,
            y,
            sample,
            value: value.to_array(),
        };
        rendered.first_anomalies.extend(anomalies.first.iter().map(named));
    }
    rendered.first_anomalies.truncate(MAX_ANOMALIES);
    rendered
}

/// Number of rays, shadow rays included, that this thread and those of the pool have traced since the last call. A job that
/// cannot be divided runs on this thread.
fn take_rays(key: &Key) -> u64 {
    let own = take_counts(key);
    let pool = rayon::broadcast(|_| take_counts(key));
    let all = pool.into_iter().chain([own]);
    all.map(|counts| u64::from(counts.rays) + u64::from(counts.shadow_rays)).sum()
}
