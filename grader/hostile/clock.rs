//! Answers with the time of day.

use arty::prelude::*;

pub struct PathTracer;

impl PathTracer {
    pub fn new(_: Settings) -> Self {
        Self
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, scene: &Scene, ray: Ray, _: &mut Sampler) -> Rgb {
        let _ = scene.intersect(&ray);
        let now = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH);
        Rgb::gray(now.map_or(0.0, |now| now.subsec_millis() as f32 / 1000.0))
    }
}
