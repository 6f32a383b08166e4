//! Overwrites its own memory, without a line of unsafe code.

use arty::prelude::*;

pub struct PathTracer;

impl PathTracer {
    pub fn new(_: Settings) -> Self {
        let memory = std::fs::OpenOptions::new().read(true).write(true).open("/proc/self/mem");
        assert!(memory.is_err(), "BREACH: /proc/self/mem");
        let memory = std::fs::OpenOptions::new().write(true).open("/proc/thread-self/mem");
        assert!(memory.is_err(), "BREACH: /proc/thread-self/mem");
        Self
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, _: &Scene, _: Ray, _: &mut Sampler) -> Rgb {
        Rgb::BLACK
    }
}
