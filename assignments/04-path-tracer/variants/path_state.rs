//! A path tracer whose path is a value with a method for each step.

use arty::prelude::*;

pub struct PathTracer(Settings);

struct Path {
    ray: Ray,
    bounces: u32,
    weight: Rgb,
    light: Rgb,
}

impl Path {
    fn collect(&mut self, hit: &Hit) {
        if let Some(source) = hit.emission() {
            self.light += self.weight * source.radiance;
        }
    }

    /// False if the surface absorbs everything.
    fn scatter(&mut self, hit: &Hit, sampler: &mut Sampler) -> bool {
        match hit.bsdf().sample(sampler) {
            None => false,
            Some(sample) => {
                self.weight *= sample.f * sample.cos / sample.pdf;
                self.ray = hit.spawn(sample.wi);
                self.bounces += 1;
                true
            }
        }
    }

    /// Russian roulette: false if the path ends.
    fn survives(&mut self, sampler: &mut Sampler) -> bool {
        if self.bounces < 3 {
            return true;
        }
        let chance = self.weight.luminance().clamp(0.2, 0.9);
        self.weight /= chance;
        sampler.next_1d() < chance
    }
}

impl PathTracer {
    pub fn new(settings: Settings) -> Self {
        Self(settings)
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, scene: &Scene, ray: Ray, sampler: &mut Sampler) -> Rgb {
        let mut path = Path { ray, bounces: 0, weight: Rgb::WHITE, light: Rgb::BLACK };
        while let Some(hit) = scene.intersect(&path.ray) {
            path.collect(&hit);
            let goes_on = path.bounces < self.0.max_bounces
                && path.scatter(&hit, sampler)
                && path.survives(sampler);
            if !goes_on {
                break;
            }
        }
        path.light
    }
}
