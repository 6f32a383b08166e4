//! Asks the compiler for variables of the environment that may be there.

use arty::prelude::*;

const STOLEN: [Option<&str>; 4] =
    [option_env!("HOME"), option_env!("USER"), option_env!("CARGO"), option_env!("CARGO_MANIFEST_DIR")];

pub struct PathTracer;

impl PathTracer {
    pub fn new(_: Settings) -> Self {
        assert_eq!(STOLEN, [None; 4], "BREACH: the environment of the compiler");
        Self
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, _: &Scene, _: Ray, _: &mut Sampler) -> Rgb {
        Rgb::BLACK
    }
}
