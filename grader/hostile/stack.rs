//! Calls itself for ever.

use arty::prelude::*;

fn deeper(n: u64) -> u64 {
    if n == 0 { 0 } else { std::hint::black_box(deeper(n - 1)) + 1 }
}

pub struct PathTracer;

impl PathTracer {
    pub fn new(_: Settings) -> Self {
        Self
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, _: &Scene, _: Ray, _: &mut Sampler) -> Rgb {
        println!("{}", deeper(u64::MAX));
        Rgb::BLACK
    }
}
