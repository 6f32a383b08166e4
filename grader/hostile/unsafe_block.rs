//! Writes where it likes.

use arty::prelude::*;

pub struct PathTracer;

impl PathTracer {
    pub fn new(_: Settings) -> Self {
        unsafe { std::ptr::null_mut::<u8>().write(1) };
        Self
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, _: &Scene, _: Ray, _: &mut Sampler) -> Rgb {
        Rgb::BLACK
    }
}
