//! Lifts the ban on unsafe code.

use arty::prelude::*;

#[allow(unsafe_code)]
fn write() {
    unsafe { std::ptr::null_mut::<u8>().write(1) };
}

pub struct PathTracer;

impl PathTracer {
    pub fn new(_: Settings) -> Self {
        write();
        Self
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, _: &Scene, _: Ray, _: &mut Sampler) -> Rgb {
        Rgb::BLACK
    }
}
