//! Exercise 6: light from the environment.
//!
//! This is the path tracer of the previous sheet. It knows the lights of a scene, but not its environment. Complete the
//! places marked `TASK … END`:
//!
//! - `EnvironmentSampler` (6.1) samples directions in proportion to the light that arrives from them: build its tables,
//!   then `sample` and `pdf`;
//! - `PathTracer` (6.2) finds that light as its technique says: `bsdf` where a ray leaves the scene, `nee` by sampling
//!   the environment as one more light, `mis` by both with the balance heuristic.
//!
//! This file is your submission. You may change it as you like, add functions and types, and use `std` and
//! `arty::prelude`, as long as it defines `PathTracer` and `EnvironmentSampler` with the functions below. `cargo api`
//! shows the documentation of the prelude.

use arty::prelude::*;

/// Samples directions with a density proportional to the luminance of an environment.
pub struct EnvironmentSampler {
    // TASK 6.1: what do `sample` and `pdf` need?
    // END 6.1
}

impl EnvironmentSampler {
    /// Builds the tables, once for each scene.
    pub fn new(environment: &Environment) -> Self {
        // TASK 6.1: the probability of a texel is proportional to its luminance times its solid angle.
        let _ = environment; // Delete this line once you use it.
        Self {}
        // END 6.1
    }
}

impl SampleDirections for EnvironmentSampler {
    /// Samples a direction towards the environment. `None` if no light arrives from it.
    fn sample(&self, environment: &Environment, sampler: &mut Sampler) -> Option<DirectionSample> {
        // TASK 6.1: select a texel, then a direction in it.
        let _ = (environment, sampler); // Delete this line once you use them.
        None
        // END 6.1
    }

    /// The density per solid angle with which `sample` samples the direction `wi`.
    fn pdf(&self, environment: &Environment, wi: Vec3) -> f32 {
        // TASK 6.1: it has to be the density of `sample`, for every direction.
        let _ = (environment, wi); // Delete this line once you use them.
        0.0
        // END 6.1
    }
}

// TASK 6.1: if you want functions of your own, they can go here.
// END 6.1

/// First bounce at which Russian roulette applies.
const ROULETTE_START: u32 = 5;

/// A path tracer: follows one path from the camera and sums the light found along it.
pub struct PathTracer {
    settings: Settings,
    /// `None` for a scene without an environment.
    environment_sampler: Option<EnvironmentSampler>,
}

impl PathTracer {
    /// A path tracer for a scene, with the given technique and maximum number of bounces.
    pub fn new(settings: Settings, scene: &Scene) -> Self {
        Self { settings, environment_sampler: scene.environment().map(EnvironmentSampler::new) }
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, scene: &Scene, mut ray: Ray, sampler: &mut Sampler) -> Rgb {
        // The light found so far, and the throughput: the product of f · cos / pdf over all bounces.
        let mut radiance = Rgb::BLACK;
        let mut throughput = Rgb::WHITE;
        // None at the camera and after a delta bounce: no light sample could have taken its place.
        let mut last_bounce: Option<LastBounce> = None;

        for bounce in 0..=self.settings.max_bounces {
            let Some(hit) = scene.intersect(&ray) else {
                // 1. Add the light of the environment, if the ray has left the scene.
                radiance += throughput * self.escaped(scene, &ray, last_bounce);
                break;
            };

            // 2. Add the emission of the light that the path has hit, if it has hit one.
            if let Some(emission) = hit.emission() {
                let weight = self.emission_weight(scene, &hit, &emission, last_bounce);
                radiance += throughput * emission.radiance * weight;
            }
            if bounce == self.settings.max_bounces {
                break;
            }

            // 3. Add direct light by next event estimation.
            let bsdf = hit.bsdf();
            if self.settings.technique != Technique::Bsdf && !bsdf.is_delta() {
                radiance += throughput * self.direct_light(scene, &hit, &bsdf, sampler);
            }

            // 4. Sample the BSDF for the direction of the next ray.
            let Some(sample) = bsdf.sample(sampler) else { break };
            throughput *= sample.f * (sample.cos / sample.pdf);
            last_bounce = (!sample.is_delta).then_some(LastBounce { point: hit.point, p_brdf: sample.pdf });

            // 5. Russian roulette: the lower the throughput, the more likely the path ends.
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

/// What the weight of light at the end of a ray depends on.
#[derive(Clone, Copy)]
struct LastBounce {
    /// The hit point where the path bounced, in world space.
    point: Vec3,
    /// Density per solid angle with which the direction was sampled.
    p_brdf: f32,
}

impl PathTracer {
    /// The light that a ray finds which has left the scene, with its weight for the technique.
    fn escaped(&self, scene: &Scene, ray: &Ray, last_bounce: Option<LastBounce>) -> Rgb {
        // TASK 6.2a, 6.2b, 6.2c: how much of the environment's light counts, given that next event estimation could have found it?
        let _ = (scene, ray, last_bounce, &self.environment_sampler); // Delete this line once you use them.
        Rgb::BLACK
        // END 6.2a, 6.2b, 6.2c
    }

    /// Next event estimation: an estimate of the direct light that `hit` reflects towards the viewer, from one light,
    /// with its weight for the technique.
    fn direct_light(&self, scene: &Scene, hit: &Hit, bsdf: &Bsdf, sampler: &mut Sampler) -> Rgb {
        let pick = sampler.next_1d() * number_of_lights(scene) as f32;
        match scene.lights().get(pick as usize) {
            Some(light) => self.light_from(light, scene, hit, bsdf, sampler),
            None => self.light_from_environment(scene, hit, bsdf, sampler),
        }
    }

    /// The contribution of the environment, from one direction sampled by `EnvironmentSampler`.
    fn light_from_environment(&self, scene: &Scene, hit: &Hit, bsdf: &Bsdf, sampler: &mut Sampler) -> Rgb {
        // TASK 6.2b, 6.2c: sample a direction, and trace a single shadow ray.
        let _ = (scene, hit, bsdf, sampler); // Delete this line once you use them.
        Rgb::BLACK
        // END 6.2b, 6.2c
    }

    /// The contribution of one light of the scene, from a random point on it.
    fn light_from(&self, light: &Light, scene: &Scene, hit: &Hit, bsdf: &Bsdf, sampler: &mut Sampler) -> Rgb {
        let Some(sample) = light.sample_direct(hit.point, sampler) else { return Rgb::BLACK };
        let (wi, distance) = direction_and_distance(hit.point, sample.point);
        let f = bsdf.eval(wi);
        if f.is_black() || scene.occluded(hit, sample.point) {
            return Rgb::BLACK;
        }
        let p_ne = p_light(scene) * sample.pdf_area * distance * distance / sample.cos_light;
        // No path ever hits a light without an area.
        let weight = if light.has_area() { self.light_weight(p_ne, bsdf.pdf(wi)) } else { 1.0 };
        f * sample.emitted * (hit.cos(wi) * weight / p_ne)
    }

    /// The weight of a light sample that a path could have found, too.
    fn light_weight(&self, p_ne: f32, p_brdf: f32) -> f32 {
        if self.settings.technique == Technique::Mis { balance(p_ne, p_brdf) } else { 1.0 }
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
        let Some(LastBounce { point, p_brdf }) = last_bounce else { return 1.0 };
        match self.settings.technique {
            Technique::Nee => 0.0,
            Technique::Bsdf => 1.0,
            Technique::Mis => {
                let (_, distance) = direction_and_distance(point, hit.point);
                let p_ne = p_light(scene) * emission.pdf_area * distance * distance / emission.cos_light;
                balance(p_brdf, p_ne)
            }
        }
    }
}

/// The number of lights that next event estimation selects from.
fn number_of_lights(scene: &Scene) -> usize {
    // TASK 6.2b, 6.2c: the environment is one more light.
    scene.lights().len()
    // END 6.2b, 6.2c
}

/// The selection probability: with which next event estimation picks each of the lights.
fn p_light(scene: &Scene) -> f32 {
    1.0 / number_of_lights(scene) as f32
}

/// The balance heuristic p / (p + q), where p is the density of the technique to be weighted. As a quotient of
/// densities it does not overflow where their sum would.
fn balance(p: f32, q: f32) -> f32 {
    1.0 / (1.0 + q / p)
}
