//! A path tracer that follows the equation: the radiance at a hit is its emission and the reflected radiance.

use arty::prelude::*;

pub struct PathTracer {
    max_bounces: u32,
}

impl PathTracer {
    pub fn new(settings: Settings) -> Self {
        Self { max_bounces: settings.max_bounces }
    }

    /// Radiance that arrives along `ray`, which has been scattered `depth` times. `reach` is how much of it arrives at the
    /// camera.
    fn arriving(&self, scene: &Scene, ray: Ray, depth: u32, reach: Rgb, sampler: &mut Sampler) -> Rgb {
        let Some(hit) = scene.intersect(&ray) else { return Rgb::BLACK };
        let emitted = hit.emission().map_or(Rgb::BLACK, |emission| emission.radiance);
        if depth >= self.max_bounces {
            return emitted;
        }
        let Some(next) = hit.bsdf().sample(sampler) else { return emitted };
        let mut share = next.f * (next.cos / next.pdf);
        let reach = reach * share;
        if depth > 3 {
            let go_on = reach.max_channel().clamp(0.1, 0.9);
            if sampler.next_1d() > go_on {
                return emitted;
            }
            share = share / go_on;
        }
        emitted + share * self.arriving(scene, hit.spawn(next.wi), depth + 1, reach, sampler)
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, scene: &Scene, ray: Ray, sampler: &mut Sampler) -> Rgb {
        self.arriving(scene, ray, 0, Rgb::WHITE, sampler)
    }
}
