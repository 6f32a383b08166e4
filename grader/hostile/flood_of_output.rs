//! Prints a great deal.

use arty::prelude::*;

pub struct PathTracer;

impl PathTracer {
    pub fn new(_: Settings) -> Self {
        let line = "points: 70 of 70 ".repeat(1 << 12);
        for _ in 0..1000 {
            println!("{line}");
        }
        Self
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, _: &Scene, _: Ray, _: &mut Sampler) -> Rgb {
        Rgb::BLACK
    }
}
