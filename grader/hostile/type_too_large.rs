//! Asks for an array larger than memory.

use arty::prelude::*;

static LARGE: [u8; 1 << 46] = [1; 1 << 46];

pub struct PathTracer;

impl PathTracer {
    pub fn new(_: Settings) -> Self {
        println!("{}", LARGE[7]);
        Self
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, _: &Scene, _: Ray, _: &mut Sampler) -> Rgb {
        Rgb::BLACK
    }
}
