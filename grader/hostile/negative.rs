//! Answers with negative light.

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
        Rgb::gray(-1.0)
    }
}
