//! Runs the host once more, within itself.

use arty::prelude::*;

pub struct PathTracer;

impl PathTracer {
    pub fn new(_: Settings) -> Self {
        let mut line = String::new();
        let _ = std::io::stdin().read_line(&mut line);
        assert!(line.is_empty(), "BREACH: requests can be read");
        let _ = host::serve(host::Submission { path_tracer: |_, _| unreachable!(), directions: None });
        Self
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, _: &Scene, _: Ray, _: &mut Sampler) -> Rgb {
        Rgb::BLACK
    }
}
