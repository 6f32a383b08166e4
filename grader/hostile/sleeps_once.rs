//! Sleeps in each of its processes for almost as long as it may.

use std::sync::Once;
use std::time::Duration;

use arty::prelude::*;

static ONCE: Once = Once::new();

pub struct PathTracer;

impl PathTracer {
    pub fn new(_: Settings) -> Self {
        ONCE.call_once(|| std::thread::sleep(Duration::from_millis(1800)));
        Self
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, _: &Scene, _: Ray, _: &mut Sampler) -> Rgb {
        Rgb::BLACK
    }
}
