//! Rendering the batches of a job.

use std::sync::atomic::AtomicBool;

use arty::film::{Anomaly, Film};
use arty::probe::{Counts, Key, take_counts};
use arty::render::render;
use arty::scene::Scene;
use cpu_time::ProcessTime;
use rayon::iter::{IntoParallelRefIterator, ParallelIterator};

use crate::constructor::Constructor;
use crate::protocol::{AnomalousSample, RenderJob, Rendered};

/// Maximum number of anomalous samples in a response.
const MAX_ANOMALIES: usize = 16;

/// Renders the batches in parallel, each with its own seed and all with one path tracer.
pub(crate) fn batches(key: &Key, constructor: Constructor, scene: &Scene, job: &RenderJob) -> Rendered {
    let integrator = constructor(job.settings);
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
                seed,
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
        cpu_seconds: start.elapsed().as_secs_f64(),
        rays: take_rays(key),
    };
    for (seed, film) in films {
        rendered.batches.push(film.pixels().iter().map(|pixel| pixel.mean().to_array()).collect());
        let anomalies = film.anomalies();
        rendered.non_finite += anomalies.non_finite;
        rendered.negative += anomalies.negative;
        let named = |&Anomaly { x, y, sample, value }: &Anomaly| AnomalousSample {
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

/// Number of rays that all threads have traced since the last call.
fn take_rays(key: &Key) -> u64 {
    let of_thread = |Counts { rays, shadow_rays, .. }: Counts| u64::from(rays) + u64::from(shadow_rays);
    rayon::broadcast(|_| of_thread(take_counts(key))).into_iter().sum()
}
