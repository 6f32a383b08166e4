//! Asks for a type within a type, for ever.

use arty::prelude::*;

fn deeper<T: Copy>(depth: u64, value: T) -> u64 {
    if depth == 0 { 0 } else { deeper(depth - 1, (value, value)) }
}

pub struct PathTracer;

impl PathTracer {
    pub fn new(_: Settings) -> Self {
        println!("{}", deeper(1 << 40, 0_u8));
        Self
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, _: &Scene, _: Ray, _: &mut Sampler) -> Rgb {
        Rgb::BLACK
    }
}
