//! Asks for the key to the counts of its rays.

use arty::prelude::*;

pub struct PathTracer;

impl PathTracer {
    pub fn new(_: Settings) -> Self {
        Self
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, _: &Scene, _: Ray, _: &mut Sampler) -> Rgb {
        let key = arty::probe::Key::take();
        assert!(key.is_none(), "BREACH: its rays can be hidden");
        Rgb::BLACK
    }
}
