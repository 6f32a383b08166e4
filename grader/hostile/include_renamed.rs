//! Reads a file by another name of the macro.

use arty::prelude::*;

use std::include_str as harmless;

const STOLEN: &str = harmless!("/etc/passwd");

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
