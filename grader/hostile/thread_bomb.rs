//! Starts threads until no more can be started.

use arty::prelude::*;

pub struct PathTracer;

impl PathTracer {
    pub fn new(_: Settings) -> Self {
        let sleep = || std::thread::sleep(std::time::Duration::from_secs(3600));
        while std::thread::Builder::new().spawn(sleep).is_ok() {}
        Self
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, _: &Scene, _: Ray, _: &mut Sampler) -> Rgb {
        Rgb::BLACK
    }
}
