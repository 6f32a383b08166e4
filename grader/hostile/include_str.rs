//! Reads a file of the system into the program.

use arty::prelude::*;

const STOLEN: &str = include_str!("/etc/passwd");

pub struct PathTracer;

impl PathTracer {
    pub fn new(_: Settings) -> Self {
        println!("{STOLEN}");
        Self
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, _: &Scene, _: Ray, _: &mut Sampler) -> Rgb {
        Rgb::BLACK
    }
}
