#!/* What rustc takes for a line for a shell, others take for the beginning of a comment, which hides what follows.
use arty::prelude::*;

fn hidden() {
    unsafe {}
}

pub struct PathTracer;

impl PathTracer {
    pub fn new(_: Settings) -> Self {
        hidden();
        Self
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, _: &Scene, _: Ray, _: &mut Sampler) -> Rgb {
        Rgb::BLACK
    }
}
// */ fn seen() {}
