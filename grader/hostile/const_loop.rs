//! Computes a constant for ever.

use arty::prelude::*;

#[allow(long_running_const_eval)]
const FOREVER: u64 = {
    let mut n = 0_u64;
    while n < u64::MAX {
        n += 1;
    }
    n
};

pub struct PathTracer;

impl PathTracer {
    pub fn new(_: Settings) -> Self {
        println!("{FOREVER}");
        Self
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, _: &Scene, _: Ray, _: &mut Sampler) -> Rgb {
        Rgb::BLACK
    }
}
