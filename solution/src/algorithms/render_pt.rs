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
        // Where it was and the density of its direction; nothing if a light sample could not have taken its place:
        // at the camera, and after a delta bounce.
        let mut last_bounce: Option<(Vec3, f32)> = None;
        // END 5.1b, 5.2b

        for bounce in 0..=self.settings.max_bounces {
            let Some(hit) = scene.intersect(&ray) else { break };

            // 1. Has the path hit a light? Then add what it emits.
            if let Some(light) = hit.light() {
                let emission = light.emission(&hit);

                // TASK 5.1b, 5.2b: how much of it counts, if next event estimation could have found it too?
                let weight = match (self.settings.technique, last_bounce) {
                    (Technique::Bsdf, _) | (_, None) => 1.0,
                    (Technique::Nee, Some(_)) => 0.0,
                    (Technique::Mis, Some((from, p_brdf))) => {
                        let (_, distance) = direction_and_distance(from, hit.point);
                        let p_ne =
                            pick_probability(scene) * emission.pdf_area * distance * distance / emission.cos;
                        balance(p_brdf, p_ne)
                    }
                };
                // END 5.1b, 5.2b

                radiance += throughput * emission.radiance * weight;
            }
            if bounce == self.settings.max_bounces {
                break;
            }
            let bsdf = hit.bsdf();

            // 2. Ask a light.
            // TASK 5.1a, 5.2b: add the contribution of a random point on a random light, with a single shadow ray.
            if self.settings.technique != Technique::Bsdf && !bsdf.is_delta() {
                radiance += throughput * self.direct_light(scene, &hit, &bsdf, sampler);
            }
            // END 5.1a, 5.2b

            // 3. Go on in a random direction.
            let Some(sample) = bsdf.sample(sampler) else { break };
            throughput *= sample.f * (sample.cos / sample.pdf);

            // TASK 5.1b, 5.2b: remember what you need of this bounce.
            last_bounce = (!sample.is_delta).then_some((hit.point, sample.pdf));
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
impl PathTracer {
    /// Next event estimation: the light that one random point on one random light sends to the viewer by way of
    /// `hit`, divided by the density of that choice per solid angle; for MIS, times its weight.
    fn direct_light(&self, scene: &Scene, hit: &Hit, bsdf: &Bsdf, sampler: &mut Sampler) -> Rgb {
        let pick = sampler.next_1d() * scene.lights().len() as f32;
        let Some(light) = scene.lights().get(pick as usize) else { return Rgb::BLACK };
        let Some(sample) = light.sample_direct(hit.point, sampler) else { return Rgb::BLACK };

        let (wi, distance) = direction_and_distance(hit.point, sample.point);
        let f = bsdf.eval(wi);
        if f.is_black() || scene.occluded(hit, sample.point) {
            return Rgb::BLACK;
        }
        let p_ne = pick_probability(scene) * sample.pdf_area * distance * distance / sample.cos;
        let weight = match self.settings.technique {
            // A light without an area is never hit by chance.
            Technique::Mis if light.has_area() => balance(p_ne, bsdf.pdf(wi)),
            _ => 1.0,
        };
        f * sample.intensity * (hit.cos(wi) * weight / p_ne)
    }
}

/// The probability with which next event estimation picks each light.
fn pick_probability(scene: &Scene) -> f32 {
    1.0 / scene.lights().len() as f32
}

/// The balance heuristic, p / (p + q), for the technique whose density is p; as a quotient of densities it holds
/// where their sum would overflow.
fn balance(p: f32, q: f32) -> f32 {
    1.0 / (1.0 + q / p)
}
// END 5.1a, 5.2b
