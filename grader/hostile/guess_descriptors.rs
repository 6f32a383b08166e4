//! Opens the pipe to the grader by guessing its number.

use arty::prelude::*;

pub struct PathTracer;

impl PathTracer {
    pub fn new(_: Settings) -> Self {
        for number in 0..64 {
            for folder in ["/dev/fd", "/proc/self/fd"] {
                let path = format!("{folder}/{number}");
                assert!(std::fs::OpenOptions::new().write(true).open(&path).is_err(), "BREACH: {path}");
                assert!(std::fs::File::open(&path).is_err(), "BREACH: {path}");
            }
        }
        Self
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, _: &Scene, _: Ray, _: &mut Sampler) -> Rgb {
        Rgb::BLACK
    }
}
