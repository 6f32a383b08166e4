//! Has the framework write a file for it.

use arty::prelude::*;

pub struct PathTracer;

impl PathTracer {
    pub fn new(_: Settings) -> Self {
        let written = arty::image::write_aside(std::path::Path::new("/tmp/arty-owned"), |_| Ok(()));
        assert!(written.is_err(), "BREACH: the framework wrote");
        Self
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, _: &Scene, _: Ray, _: &mut Sampler) -> Rgb {
        Rgb::BLACK
    }
}
