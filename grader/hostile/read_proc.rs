//! Reads what the system knows of its process.

use arty::prelude::*;

pub struct PathTracer;

impl PathTracer {
    pub fn new(_: Settings) -> Self {
        for file in ["environ", "maps", "mem", "cmdline", "status", "exe", "cgroup", "task"] {
            let path = format!("/proc/self/{file}");
            assert!(std::fs::File::open(&path).is_err(), "BREACH: {path}");
            assert!(std::fs::read_link(&path).is_err(), "BREACH: {path}");
        }
        assert!(std::fs::read_dir("/proc").is_err(), "BREACH: /proc");
        Self
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, _: &Scene, _: Ray, _: &mut Sampler) -> Rgb {
        Rgb::BLACK
    }
}
