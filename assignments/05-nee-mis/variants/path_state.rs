use arty::prelude::*;

pub struct PathTracer {
    settings: Settings,
}

struct Path {
    ray: Ray,
    result: Rgb,
    throughput: Rgb,
    bounces: u32,
    pdf: f32,
    from: Vec3,
    specular: bool,
}

impl Path {
    fn start(ray: Ray) -> Path {
        Path {
            ray,
            result: Rgb::BLACK,
            throughput: Rgb::WHITE,
            bounces: 0,
            pdf: 1.0,
            from: ray.origin,
            specular: true,
        }
    }

    fn advance(&mut self, hit: &Hit, sample: &BsdfSample) {
        self.throughput = self.throughput * sample.f * sample.cos / sample.pdf;
        self.pdf = sample.pdf;
        self.specular = sample.is_delta;
        self.from = hit.point;
        self.ray = hit.spawn(sample.wi);
        self.bounces += 1;
    }
}

/// Area density to solid angle density.
fn to_solid_angle(pdf_area: f32, distance: f32, cos: f32) -> f32 {
    pdf_area * distance.powi(2) / cos
}

fn weight(technique: Technique, own: f32, other: f32) -> f32 {
    match technique {
        Technique::Mis => own / (own + other),
        _ => 1.0,
    }
}

impl PathTracer {
    pub fn new(settings: Settings) -> Self {
        Self { settings }
    }

    fn select<'a>(&self, scene: &'a Scene, sampler: &mut Sampler) -> Option<(&'a Light, f32)> {
        let lights = scene.lights();
        let (u, _) = sampler.next_2d();
        lights.get((u * lights.len() as f32).floor() as usize).map(|light| (light, 1.0 / lights.len() as f32))
    }

    fn next_event(&self, scene: &Scene, hit: &Hit, path: &mut Path, sampler: &mut Sampler) {
        match self.select(scene, sampler) {
            None => {}
            Some((light, pick)) => match light.sample_direct(hit.point, sampler) {
                None => {}
                Some(sample) => {
                    let (wi, distance) = direction_and_distance(hit.point, sample.point);
                    match scene.occluded(hit, sample.point) {
                        true => {}
                        false => {
                            let bsdf = hit.bsdf();
                            let p_ne = pick * to_solid_angle(sample.pdf_area, distance, sample.cos_light);
                            let p_brdf = if light.has_area() { bsdf.pdf(wi) } else { 0.0 };
                            let w = weight(self.settings.technique, p_ne, p_brdf);
                            path.result +=
                                w * path.throughput * bsdf.eval(wi) * sample.emitted * hit.cos(wi) / p_ne;
                        }
                    }
                }
            },
        }
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, scene: &Scene, ray: Ray, sampler: &mut Sampler) -> Rgb {
        let technique = self.settings.technique;
        let mut path = Path::start(ray);
        while let Some(hit) = scene.intersect(&path.ray) {
            if let Some(emission) = hit.emission() {
                let w = match (path.specular, technique) {
                    (true, _) | (_, Technique::Bsdf) => 1.0,
                    (false, Technique::Nee) => 0.0,
                    (false, Technique::Mis) => {
                        let distance = (hit.point - path.from).length();
                        let pick = 1.0 / scene.lights().len() as f32;
                        let p_ne = pick * to_solid_angle(emission.pdf_area, distance, emission.cos_light);
                        weight(technique, path.pdf, p_ne)
                    }
                };
                path.result += path.throughput * emission.radiance * w;
            }
            if path.bounces >= self.settings.max_bounces {
                break;
            }
            if technique != Technique::Bsdf && !hit.bsdf().is_delta() {
                self.next_event(scene, &hit, &mut path, sampler);
            }
            match hit.bsdf().sample(sampler) {
                Some(sample) => path.advance(&hit, &sample),
                None => break,
            }
        }
        path.result
    }
}
