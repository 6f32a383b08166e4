//! Exercise 5: next event estimation and multiple importance sampling.
//!
//! This is the path tracer of the previous sheet: it finds light only when a path happens to hit a light source.
//! Complete the places marked `TASK … END`, so that each technique does what its name says:
//!
//! - `bsdf`: BSDF sampling alone, as now;
//! - `nee` (5.1): next event estimation at every hit point, with no light counted twice;
//! - `mis` (5.2): both combined by multiple importance sampling with the balance heuristic.
//!
//! There are two functions to write, `direct_light` and `emission_weight`, and one decision to make: what to remember
//! of the last bounce, in `LastBounce`.
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
        // None at the camera.
        let mut last_bounce: Option<LastBounce> = None;

        for bounce in 0..=self.settings.max_bounces {
            let Some(hit) = scene.intersect(&ray) else { break };

            // 1. Add the emission of the light that the path has hit, if it has hit one.
            if let Some(emission) = hit.emission() {
                let weight = self.emission_weight(scene, &hit, &emission, last_bounce);
                radiance += throughput * emission.radiance * weight;
            }
            if bounce == self.settings.max_bounces {
                break;
            }

            // 2. Add direct light by next event estimation.
            let bsdf = hit.bsdf();
            radiance += throughput * self.direct_light(scene, &hit, &bsdf, sampler);

            // 3. Sample the BSDF for the direction of the next ray.
            let Some(sample) = bsdf.sample(sampler) else { break };
            throughput *= sample.f * (sample.cos / sample.pdf);

            // TASK 5.1b, 5.2b: remember what `emission_weight` has to know about this bounce.
            last_bounce = Some(LastBounce {});
            // END 5.1b, 5.2b

            // 4. Russian roulette: the lower the throughput, the more likely the path ends.
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

impl PathTracer {
    /// Next event estimation: an estimate of the direct light that `hit` reflects towards the viewer, from one random
    /// point on one random light. Black for the technique `bsdf`; includes the MIS weight for the technique `mis`.
    fn direct_light(&self, scene: &Scene, hit: &Hit, bsdf: &Bsdf, sampler: &mut Sampler) -> Rgb {
        // TASK 5.1a, 5.2b: sample a light and a point on it, and trace a single shadow ray.
        let _ = (scene, hit, bsdf, sampler); // Delete this line once you use them.
        Rgb::BLACK
        // END 5.1a, 5.2b
    }

    /// The weight of the emission at `hit`: how much of it counts, given that next event estimation at the last bounce
    /// could have found the same light. 1 for the technique `bsdf`.
    fn emission_weight(
        &self,
        scene: &Scene,
        hit: &Hit,
        emission: &Emission,
        last_bounce: Option<LastBounce>,
    ) -> f32 {
        // TASK 5.1b, 5.2b: which light can next event estimation not find? What is the MIS weight of the rest?
        let _ = (scene, hit, emission, last_bounce); // Delete this line once you use them.
        1.0
        // END 5.1b, 5.2b
    }
}

/// What `emission_weight` has to know about the bounce before a hit.
#[derive(Clone, Copy)]
// TASK 5.1b, 5.2b: which fields does it need? If you want functions of your own, they can go here, too.
struct LastBounce {}
// END 5.1b, 5.2b
