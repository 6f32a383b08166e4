//! Puts commands for a terminal, a web page and a CI system into an error.

use arty::prelude::*;

compile_error!(
    "\u{1b}[2J\u{1b}]0;owned\u{7}\n::error file=a.rs,line=1::owned\n##[error]owned\n<script>alert(1)</script>"
);

pub struct PathTracer;

impl PathTracer {
    pub fn new(_: Settings) -> Self {
        Self
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, _: &Scene, _: Ray, _: &mut Sampler) -> Rgb {
        Rgb::BLACK
    }
}
