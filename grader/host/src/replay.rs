//! Replaying one path with every call recorded.

use std::path::Path;

use arty::math::{Rgb, first_non_finite_sum};
use arty::probe::{self, Key, start_recording, take_recording};
use arty::render::sample_pixel;
use arty::sampler::Streams;
use arty::scene::Scene;

use crate::protocol::{Call, ReplayJob, Replayed};
use crate::submission::Submission;

/// Computes one sample again and records its calls.
pub(crate) fn path(key: &Key, submission: Submission, scene: &Scene, job: &ReplayJob) -> Replayed {
    let integrator = (submission.path_tracer)(job.settings, scene);
    let [width, height] = job.size;
    let [x, y] = job.pixel;
    let camera = scene.camera(width, height);
    start_recording(key);
    let radiance =
        sample_pixel(&*integrator, scene, &camera, Streams::independent(job.seed), (x, y), job.sample);
    let recording = take_recording(key);
    let values = |values: Vec<probe::Value>| {
        values.into_iter().map(|value| (value.name.into_owned(), value.numbers)).collect()
    };
    let call = |call: probe::Call| Call {
        function: call.function.to_owned(),
        given: values(call.given),
        got: values(call.got),
    };
    let mut calls: Vec<Call> = recording.calls.into_iter().map(call).collect();
    calls.extend(non_finite_sum(radiance));
    Replayed { radiance: radiance.to_array(), calls, left_out: recording.left_out }
}

/// The addition after which a path's radiance was NaN or infinite, as the last entry of its calls.
fn non_finite_sum(radiance: Rgb) -> Option<Call> {
    let sum = first_non_finite_sum().filter(|_| !radiance.is_finite())?;
    let file = Path::new(sum.file()).file_name().unwrap_or_default().to_string_lossy();
    let function = "NaN or infinite since the sum in".to_owned();
    Some(Call { function, given: Vec::new(), got: vec![(format!("{file}, line"), vec![sum.line() as f32])] })
}
