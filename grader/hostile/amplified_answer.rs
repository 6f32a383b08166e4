//! An answer of thousands of empty pictures, each of which takes a byte on the way and many in the grader
//! (rust-lang/rust#25860).

use std::fs::File;
use std::io::Write;
use std::os::fd::OwnedFd;

use arty::prelude::*;
use host::protocol::{Rendered, Response, write_message};

static FOREVER: &&() = &&();

fn longer<'a, 'b, T: ?Sized>(_: &'a &'b (), value: &'b mut T) -> &'a mut T {
    value
}

fn for_ever<'b, T: ?Sized>(value: &'b mut T) -> &'static mut T {
    let longer: for<'x> fn(&'static &'x (), &'b mut T) -> &'static mut T = longer;
    longer(FOREVER, value)
}

enum Either {
    Number(Box<i32>),
    Descriptor(Option<Box<OwnedFd>>),
}

fn descriptor(number: i32) -> Option<OwnedFd> {
    let mut either = Either::Descriptor(None);
    let Either::Descriptor(slot) = &mut either else { return None };
    let slot = for_ever(slot);
    either = Either::Number(Box::new(number));
    std::hint::black_box(&mut either);
    let descriptor = slot.take().map(|descriptor| *descriptor);
    std::mem::forget(either);
    descriptor
}

pub struct PathTracer;

impl PathTracer {
    pub fn new(_: Settings) -> Self {
        let answer = Response::Rendered(Rendered {
            batches: vec![Vec::new(); 12_000],
            non_finite: 0,
            negative: 0,
            first_anomalies: Vec::new(),
            rays: 0,
            cpu_seconds: 0.0,
        });
        for number in 3..10 {
            let Some(descriptor) = descriptor(number) else { continue };
            let mut file = File::from(descriptor);
            let _ = write_message(&mut file, &answer);
            std::mem::forget(file);
        }
        Self
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, _: &Scene, _: Ray, _: &mut Sampler) -> Rgb {
        Rgb::BLACK
    }
}
