//! Runs before `main`: its assembler names a function to the linker, and all names of that are raw.

use arty::prelude::*;

extern "C" fn first() {
    println!("before main");
}

#[unsafe(r#naked)]
extern "C" fn place() {
    core::r#arch::r#naked_asm!(
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
