//! Computing samples again, with a recording of what the integrator calls.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::OnceLock;

use arty::camera::Camera;
use arty::cli::Algorithm;
use arty::math::Rgb;
use arty::probe::{Key, Recording, Value, start_recording, take_recording};
use arty::render::sample_pixel;
use arty::sampler::Streams;
use arty::scene::Scene;

use super::calls::{Call, RecordedPath};
use super::{COMPARED, DRAWN, Query, Traced};
use crate::view::Make;

/// Traces the paths that were asked for, on this thread. `size` is that of the picture in pixels.
pub fn trace(scene: &Scene, make: Make, query: &Query, size: (u32, u32), seed: u64) -> Traced {
    let integrator = make(Algorithm::PathTracer(query.settings), scene);
    let camera = Camera::new(&query.camera, size.0, size.1);
    let streams = Streams::independent(seed);
    let sample = |number| sample_pixel(&*integrator, scene, &camera, streams, query.pixel, number);
    let recorded = |number| {
        start_recording(key());
        let radiance = sample(number);
        recording_of(number, radiance, take_recording(key()))
    };
    let compute = || {
        let values: Vec<Rgb> = (0..COMPARED).map(sample).collect();
        let drawn = query.sample..query.sample.saturating_add(DRAWN);
        (values, drawn.map(recorded).collect())
    };
    let (values, paths) = match catch_unwind(AssertUnwindSafe(compute)) {
        Ok((values, paths)) => (values, Ok(paths)),
        Err(_) => {
            take_recording(key());
            (Vec::new(), Err("the algorithm panicked on a path of this pixel".to_owned()))
        }
    };
    Traced { query: *query, values, paths }
}

/// The permission to record. This program holds it from the first path on.
fn key() -> &'static Key {
    static KEY: OnceLock<Key> = OnceLock::new();
    KEY.get_or_init(|| Key::take().expect("nothing else in this program takes it"))
}

fn recording_of(sample: u64, radiance: Rgb, recording: Recording) -> RecordedPath {
    let values =
        |values: Vec<Value>| values.into_iter().map(|value| (value.name, value.numbers)).collect::<Vec<_>>();
    let calls = recording.calls.into_iter().map(|call| Call {
        function: call.function,
        given: values(call.given),
        got: values(call.got),
    });
    RecordedPath { sample, radiance, calls: calls.collect() }
}
