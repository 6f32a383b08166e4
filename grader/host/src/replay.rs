//! Replaying one path with every call recorded.

use arty::probe::{self, Key, start_recording, take_recording};
use arty::render::sample_pixel;
use arty::scene::Scene;

use crate::constructor::Constructor;
use crate::protocol::{Call, ReplayJob, Replayed};

/// Computes one sample again and records its calls.
pub(crate) fn path(key: &Key, constructor: Constructor, scene: &Scene, job: &ReplayJob) -> Replayed {
    let integrator = constructor(job.settings);
    let [width, height] = job.size;
    let [x, y] = job.pixel;
    let camera = scene.camera(width, height);
    start_recording(key);
    let radiance = sample_pixel(&*integrator, scene, &camera, job.seed, (x, y), job.sample);
    let recording = take_recording(key);
    let values = |values: Vec<probe::Value>| {
        values.into_iter().map(|value| (value.name.into_owned(), value.numbers)).collect()
    };
    let call = |call: probe::Call| Call {
        function: call.function.to_owned(),
        given: values(call.given),
        got: values(call.got),
    };
    Replayed {
        radiance: radiance.to_array(),
        calls: recording.calls.into_iter().map(call).collect(),
        left_out: recording.left_out,
    }
}
