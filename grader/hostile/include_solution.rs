//! Makes the solution a part of itself.

use arty::prelude::*;

include!("@ROOT@/solution/src/algorithms/render_pt.rs");

pub struct PathTracer;

impl PathTracer {
    pub fn new(_: Settings) -> Self {
        Self
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, _: &Scene, _: Ray, _: &mut Sampler) -> Rgb {
        Rgb::BLACK
    }
}
