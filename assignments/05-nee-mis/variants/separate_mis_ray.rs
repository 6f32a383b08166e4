use arty::prelude::*;

pub struct PathTracer {
    settings: Settings,
}

impl PathTracer {
    pub fn new(settings: Settings) -> Self {
        Self { settings }
    }

    /// Direct light at a hit: one light sample, and for MIS one BSDF sample with a ray of its own.
    fn direct(&self, scene: &Scene, hit: &Hit, bsdf: &Bsdf, sampler: &mut Sampler) -> Rgb {
        let mis = self.settings.technique == Technique::Mis;
        let count = scene.lights().len();
        if count == 0 {
            return Rgb::BLACK;
        }
        let mut sum = Rgb::BLACK;

        let light = &scene.lights()[(sampler.next_1d() * count as f32) as usize % count];
        if let Some(sample) = light.sample_direct(hit.point, sampler) {
            let (wi, distance) = direction_and_distance(hit.point, sample.point);
            if !scene.occluded(hit, sample.point) {
                let pdf = sample.pdf_area * distance * distance / sample.cos_light / count as f32;
                let weight =
                    if mis && light.has_area() { pdf / (pdf + bsdf.pdf(wi)) } else { 1.0 };
                sum += bsdf.eval(wi) * sample.emitted * hit.cos(wi) / pdf * weight;
            }
        }

        if mis && let Some(sample) = bsdf.sample(sampler) && !sample.is_delta {
            if let Some(other) = scene.intersect(&hit.spawn(sample.wi)) && let Some(emission) = other.emission() {
                let (_, distance) = direction_and_distance(hit.point, other.point);
                let pdf = emission.pdf_area * distance * distance / emission.cos_light / count as f32;
                let weight = sample.pdf / (sample.pdf + pdf);
                sum += sample.f * emission.radiance * (sample.cos / sample.pdf * weight);
            }
        }
        sum
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, scene: &Scene, mut ray: Ray, sampler: &mut Sampler) -> Rgb {
        let mut radiance = Rgb::BLACK;
        let mut beta = Rgb::WHITE;
        let mut add_emission = true;
        for bounce in 0..self.settings.max_bounces + 1 {
            let hit = match scene.intersect(&ray) {
                Some(hit) => hit,
                None => return radiance,
            };
            if add_emission && let Some(emission) = hit.emission() {
                radiance += beta * emission.radiance;
            }
            if bounce == self.settings.max_bounces {
                return radiance;
            }
            let bsdf = hit.bsdf();
            if self.settings.technique != Technique::Bsdf {
                radiance += beta * self.direct(scene, &hit, &bsdf, sampler);
            }
            let Some(sample) = bsdf.sample(sampler) else { return radiance };
            beta *= sample.f * sample.cos / sample.pdf;
            add_emission = sample.is_delta || self.settings.technique == Technique::Bsdf;
            ray = hit.spawn(sample.wi);
        }
        radiance
    }
}
