//! Exercise 4: a path tracer.
//!
//! A path starts at the camera, is scattered at each surface that it hits, and adds up the light that it finds there.
//! Complete the places marked `TASK … END`:
//!
//! - 4.1: the light that a surface emits, and where a path ends;
//! - 4.2: the direction in which the path goes on, and its throughput;
//! - 4.3: Russian roulette.
//!
//! There is one technique, `bsdf`: a path finds light only when it happens to hit a light source.
//!
//! This file is your submission. You may change it as you like, add functions and types, and use `std` and
//! `arty::prelude`, as long as it defines `PathTracer` with `new` and `radiance` as below. `cargo api` shows the
//! documentation of the prelude.

use arty::prelude::*;

/// First bounce at which Russian roulette applies.
const ROULETTE_START: u32 = 5;

/// A path tracer: follows one path from the camera and sums the light found along it.
pub struct PathTracer {
    settings: Settings,
}

impl PathTracer {
    /// A path tracer with the given technique and maximum number of bounces.
    pub fn new(settings: Settings) -> Self {
        Self { settings }
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, scene: &Scene, mut ray: Ray, sampler: &mut Sampler) -> Rgb {
        // The light found so far, and the throughput: the product of f · cos / pdf over all bounces.
        let mut radiance = Rgb::BLACK;
        let mut throughput = Rgb::WHITE;

        for bounce in 0..=self.settings.max_bounces {
            let Some(hit) = scene.intersect(&ray) else { break };

            // TASK 4.1: add the emission of the light that the path has hit, if it has hit one. When is this the last hit?
            let _ = (&hit, bounce, &mut radiance); // Delete this line once you use them.
            // END 4.1

            // TASK 4.2, 4.3: sample the BSDF, update the throughput, play Russian roulette, and set the next ray.
            let _ = (&mut throughput, &mut ray, &mut *sampler, ROULETTE_START); // Delete this line once you use them.
            break;
            // END 4.2, 4.3
        }
        radiance
    }
}
