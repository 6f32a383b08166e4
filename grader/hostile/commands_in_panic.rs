//! Puts commands for a terminal, a web page and a CI system into a panic.

use arty::prelude::*;

pub struct PathTracer;

impl PathTracer {
    pub fn new(_: Settings) -> Self {
        Self
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, _: &Scene, _: Ray, _: &mut Sampler) -> Rgb {
        panic!(
            "\u{1b}[2J\u{1b}]0;owned\u{7}\n::error file=a.rs::owned\n##[error]\r\u{202e}<script>alert(1)</script>"
        )
    }
}
