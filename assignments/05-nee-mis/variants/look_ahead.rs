use arty::prelude::*;

pub struct PathTracer {
    settings: Settings,
}

impl PathTracer {
    pub fn new(settings: Settings) -> Self {
        Self { settings }
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, scene: &Scene, ray: Ray, sampler: &mut Sampler) -> Rgb {
        let technique = self.settings.technique;
        let count = scene.lights().len() as f32;
        let mut sum = Rgb::BLACK;
        let mut beta = Rgb::WHITE;
        let mut hit_weight = 1.0;
        let Some(mut hit) = scene.intersect(&ray) else { return sum };
        let mut depth = 0;
        loop {
            if let Some(emission) = hit.emission() {
                sum += beta * hit_weight * emission.radiance;
            }
            if depth == self.settings.max_bounces {
                return sum;
            }
            let bsdf = hit.bsdf();
            if technique != Technique::Bsdf && count > 0.0 {
                let light = &scene.lights()[(sampler.next_1d() * count) as usize];
                if let Some(sample) = light.sample_direct(hit.point, sampler)
                    && !scene.occluded(&hit, sample.point)
                {
                    let (wi, d) = direction_and_distance(hit.point, sample.point);
                    let p_light = sample.pdf_area * d * d / sample.cos_light / count;
                    let p_brdf = bsdf.pdf(wi);
                    let weighted = technique == Technique::Mis && light.has_area() && p_light + p_brdf > 0.0;
                    let w = if weighted { p_light / (p_light + p_brdf) } else { 1.0 };
                    sum += beta * w * bsdf.eval(wi) * sample.emitted * (hit.cos(wi) / p_light);
                }
            }
            if depth >= 3 {
                let q = beta.max_channel().min(0.99);
                if sampler.next_1d() > q {
                    return sum;
                }
                beta /= q;
            }
            let Some(next) = bsdf.sample(sampler) else { return sum };
            beta *= next.f * (next.cos / next.pdf);
            let from = hit.point;
            let Some(found) = scene.intersect(&hit.spawn(next.wi)) else { return sum };
            hit = found;
            hit_weight = match hit.emission() {
                Some(emission) if !next.is_delta => {
                    let (_, d) = direction_and_distance(from, hit.point);
                    let p_light = emission.pdf_area * d * d / emission.cos_light / count;
                    match technique {
                        Technique::Bsdf => 1.0,
                        Technique::Nee => 0.0,
                        Technique::Mis => next.pdf / (next.pdf + p_light),
                    }
                }
                _ => 1.0,
            };
            depth += 1;
        }
    }
}
