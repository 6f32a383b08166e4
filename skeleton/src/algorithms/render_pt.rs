//! Exercise 5: next event estimation and multiple importance sampling.
//!
//! What stands here is the path tracer of the sheet before. It finds light only by hitting it by chance. Fill in
//! the places marked `TASK … END`, so that each of the three techniques does what its name says:
//!
//! - `bsdf`: light is hit by chance, as now;
//! - `nee` (5.1): each hit point also asks a random point on a random light, and no light is counted twice;
//! - `mis` (5.2): light found in both ways, weighted by the balance heuristic.
//!
//! This file is your hand-in, and nothing else is. You may change it as you like, add functions and types, and use
//! `std` and `arty::prelude`, as long as it defines `PathTracer` with `new` and `radiance` as below. To see what
//! your tools can do: `cargo doc -p arty --open`.

use arty::prelude::*;

/// From how many bounces on a path may be ended by Russian roulette.
const ROULETTE_START: u32 = 5;

/// A path tracer: it follows one path from the camera and adds up the light it finds on its way.
pub struct PathTracer {
    settings: Settings,
}

impl PathTracer {
    /// A path tracer with the technique and the longest path that the settings ask for.
    pub fn new(settings: Settings) -> Self {
        Self { settings }
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, scene: &Scene, mut ray: Ray, sampler: &mut Sampler) -> Rgb {
        // What the path has found so far, and what share of light from its end reaches the camera:
        // the product of f · cos / p over all bounces.
        let mut radiance = Rgb::BLACK;
        let mut throughput = Rgb::WHITE;

        // TASK 5.1b, 5.2b: what do you have to know about the last bounce when the path hits a light?
        // END 5.1b, 5.2b

        for bounce in 0..=self.settings.max_bounces {
            let Some(hit) = scene.intersect(&ray) else { break };

            // 1. Has the path hit a light? Then add what it emits.
            if let Some(light) = hit.light() {
                let emission = light.emission(&hit);

                // TASK 5.1b, 5.2b: how much of it counts, if next event estimation could have found it too?
                let weight = 1.0;
                // END 5.1b, 5.2b

                radiance += throughput * emission.radiance * weight;
            }
            if bounce == self.settings.max_bounces {
                break;
            }
            let bsdf = hit.bsdf();

            // 2. Ask a light.
            // TASK 5.1a, 5.2b: add the contribution of a random point on a random light, with a single shadow ray.
            // END 5.1a, 5.2b

            // 3. Go on in a random direction.
            let Some(sample) = bsdf.sample(sampler) else { break };
            throughput *= sample.f * (sample.cos / sample.pdf);

            // TASK 5.1b, 5.2b: remember what you need of this bounce.
            // END 5.1b, 5.2b

            // 4. Russian roulette: end the path by chance, the more likely the less it can still bring.
            if bounce + 1 >= ROULETTE_START {
                let survival = throughput.max_channel().min(0.95);
                if sampler.next_1d() >= survival {
                    break;
                }
                throughput /= survival;
            }
            ray = hit.spawn(sample.wi);
        }
        radiance
    }
}

// TASK 5.1a, 5.2b: functions of your own, if you want some.
// END 5.1a, 5.2b
