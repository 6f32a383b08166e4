//! Answers with the largest number.

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
        Rgb::gray(f32::MAX)
    }
}
