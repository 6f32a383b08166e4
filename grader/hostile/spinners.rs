//! Takes the processors from its neighbours with hundreds of threads, whether they start or not.

use std::sync::Once;

use arty::prelude::*;

static ONCE: Once = Once::new();

pub struct PathTracer;

impl PathTracer {
    pub fn new(_: Settings) -> Self {
        ONCE.call_once(|| {
            for _ in 0..300 {
                let spin = || {
                    loop {
                        std::hint::spin_loop();
                    }
                };
                let _ = std::thread::Builder::new().stack_size(65536).spawn(spin);
            }
        });
        Self
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, _: &Scene, _: Ray, sampler: &mut Sampler) -> Rgb {
        Rgb::gray(sampler.next_1d())
    }
}
