//! Takes all memory.

use arty::prelude::*;

pub struct PathTracer;

impl PathTracer {
    pub fn new(_: Settings) -> Self {
        let mut hoard: Vec<Vec<u8>> = Vec::new();
        while std::hint::black_box(true) {
            hoard.push(vec![0; 1 << 26]);
        }
        println!("{}", hoard.len());
        Self
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, _: &Scene, _: Ray, _: &mut Sampler) -> Rgb {
        Rgb::BLACK
    }
}
