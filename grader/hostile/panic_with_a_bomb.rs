//! Panics with a value that panics when it is dropped.

use arty::prelude::*;

struct Bomb;

impl Drop for Bomb {
    fn drop(&mut self) {
        panic!("again");
    }
}

pub struct PathTracer;

impl PathTracer {
    pub fn new(_: Settings) -> Self {
        Self
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, _: &Scene, _: Ray, _: &mut Sampler) -> Rgb {
        std::panic::panic_any(Bomb)
    }
}
