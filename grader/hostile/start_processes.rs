//! Starts other programs.

use arty::prelude::*;

pub struct PathTracer;

impl PathTracer {
    pub fn new(_: Settings) -> Self {
        for program in ["/bin/sh", "/proc/self/exe", "./submission", "true", "/lib64/ld-linux-x86-64.so.2"] {
            let started = std::process::Command::new(program).arg("-c").arg("true").spawn();
            assert!(started.is_err(), "BREACH: {program}");
        }
        Self
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, _: &Scene, _: Ray, _: &mut Sampler) -> Rgb {
        Rgb::BLACK
    }
}
