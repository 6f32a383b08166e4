//! Reads the environment and the command line.

use arty::prelude::*;

pub struct PathTracer;

impl PathTracer {
    pub fn new(_: Settings) -> Self {
        for (name, value) in std::env::vars_os() {
            assert!(name == "RAYON_NUM_THREADS", "BREACH: {name:?}={value:?}");
        }
        assert!(std::env::args_os().count() == 1, "BREACH: arguments");
        Self
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, _: &Scene, _: Ray, _: &mut Sampler) -> Rgb {
        Rgb::BLACK
    }
}
