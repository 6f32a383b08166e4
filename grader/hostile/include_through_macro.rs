//! Reads a file by way of a macro that is handed the name of another.

use arty::prelude::*;

macro_rules! call {
    ($name:ident, $file:expr) => {
        $name!($file)
    };
}

const STOLEN: &[u8] = call!(include_bytes, concat!("/proc/self", "/environ"));

pub struct PathTracer;

impl PathTracer {
    pub fn new(_: Settings) -> Self {
        println!("{}", STOLEN.len());
        Self
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, _: &Scene, _: Ray, _: &mut Sampler) -> Rgb {
        Rgb::BLACK
    }
}
