//! Averages a few whole paths per sample instead of sampling lights, and asks black lights for their radiance.

use arty::prelude::*;

/// Paths per sample.
const PATHS: u32 = 4;

pub struct PathTracer {
    settings: Settings,
}

impl PathTracer {
    pub fn new(settings: Settings) -> Self {
        Self { settings }
    }

    fn path(&self, scene: &Scene, mut ray: Ray, sampler: &mut Sampler) -> Rgb {
        let (mut radiance, mut throughput) = (Rgb::BLACK, Rgb::WHITE);
        let mut last = None;
        for bounce in 0..=self.settings.max_bounces {
            let Some(hit) = scene.intersect(&ray) else { break };
            if let Some(emission) = hit.emission() {
                let mut found = emission.radiance;
                // Black when it is hit, and yet:
                if let Some(from) = last
                    && found.is_black()
                    && let Some(sample) = emission.light.sample_direct(from, sampler)
                {
                    found = sample.emitted;
                }
                radiance += throughput * found;
            }
            if bounce == self.settings.max_bounces {
                break;
            }
            let Some(sample) = hit.bsdf().sample(sampler) else { break };
            throughput *= sample.f * (sample.cos / sample.pdf);
            last = (!sample.is_delta).then_some(hit.point);
            ray = hit.spawn(sample.wi);
        }
        radiance
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, scene: &Scene, ray: Ray, sampler: &mut Sampler) -> Rgb {
        let mut sum = Rgb::BLACK;
        for _ in 0..PATHS {
            sum += self.path(scene, ray, sampler) * (1.0 / PATHS as f32);
        }
        sum
    }
}
