use arty::prelude::*;

pub struct PathTracer {
    settings: Settings,
}

impl PathTracer {
    pub fn new(settings: Settings) -> Self {
        PathTracer { settings }
    }
}

/// Density of the previous bounce, and where it was. `specular` counts the camera too.
#[derive(Clone, Copy)]
struct Previous {
    point: Vec3,
    pdf: f32,
    specular: bool,
}

impl Integrator for PathTracer {
    fn radiance(&self, scene: &Scene, ray: Ray, sampler: &mut Sampler) -> Rgb {
        let camera = Previous { point: ray.origin, pdf: 0.0, specular: true };
        self.trace(scene, ray, sampler, 0, camera)
    }
}

impl PathTracer {
    fn trace(&self, scene: &Scene, ray: Ray, sampler: &mut Sampler, depth: u32, previous: Previous) -> Rgb {
        let hit = match scene.intersect(&ray) {
            Some(hit) => hit,
            None => return Rgb::BLACK,
        };
        let mut result = Rgb::BLACK;
        if depth < self.settings.max_bounces {
            if self.settings.technique != Technique::Bsdf {
                result += self.next_event(scene, &hit, sampler);
            }
            result += self.indirect(scene, &hit, sampler, depth);
        }
        result + self.emitted(scene, &hit, previous)
    }

    fn indirect(&self, scene: &Scene, hit: &Hit, sampler: &mut Sampler, depth: u32) -> Rgb {
        let sample = match hit.bsdf().sample(sampler) {
            Some(sample) => sample,
            None => return Rgb::BLACK,
        };
        let survive = if depth < 3 { 1.0 } else { 0.8 };
        if sampler.next_1d() > survive {
            return Rgb::BLACK;
        }
        let previous = Previous { point: hit.point, pdf: sample.pdf, specular: sample.is_delta };
        let incoming = self.trace(scene, hit.spawn(sample.wi), sampler, depth + 1, previous);
        sample.f * incoming * sample.cos / (sample.pdf * survive)
    }

    fn emitted(&self, scene: &Scene, hit: &Hit, previous: Previous) -> Rgb {
        let emission = match hit.emission() {
            Some(emission) => emission,
            None => return Rgb::BLACK,
        };
        if previous.specular || self.settings.technique == Technique::Bsdf {
            return emission.radiance;
        }
        if self.settings.technique == Technique::Nee {
            return Rgb::BLACK;
        }
        let (_, d) = direction_and_distance(previous.point, hit.point);
        let p_light = emission.pdf_area / scene.lights().len() as f32 * d * d / emission.cos_light;
        emission.radiance * (previous.pdf / (previous.pdf + p_light))
    }

    fn next_event(&self, scene: &Scene, hit: &Hit, sampler: &mut Sampler) -> Rgb {
        let n = scene.lights().len();
        if n == 0 {
            return Rgb::BLACK;
        }
        let light = &scene.lights()[((sampler.next_1d() * n as f32) as usize).min(n - 1)];
        let sample = match light.sample_direct(hit.point, sampler) {
            Some(sample) => sample,
            None => return Rgb::BLACK,
        };
        if scene.occluded(hit, sample.point) {
            return Rgb::BLACK;
        }
        let (wi, d) = direction_and_distance(hit.point, sample.point);
        let bsdf = hit.bsdf();
        let geometry = hit.cos(wi) * sample.cos_light / (d * d);
        let mut result = bsdf.eval(wi) * sample.emitted * geometry * n as f32 / sample.pdf_area;
        if self.settings.technique == Technique::Mis && light.has_area() {
            let p_light = sample.pdf_area / n as f32 * d * d / sample.cos_light;
            result *= p_light / (p_light + bsdf.pdf(wi));
        }
        result
    }
}
