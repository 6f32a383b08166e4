use arty::prelude::*;

pub struct PathTracer {
    settings: Settings,
}

/// One hit point of a traced path, as seen from the camera's side.
struct Vertex {
    /// Emission towards the vertex before, weighted.
    emitted: Rgb,
    /// Light sample, weighted.
    direct: Rgb,
    /// f · cos / density of the bounce from here to the next vertex; black at the end.
    bounce: Rgb,
}

impl PathTracer {
    pub fn new(settings: Settings) -> Self {
        Self { settings }
    }

    fn solid_angle(scene: &Scene, pdf_area: f32, cos: f32, d: f32) -> f32 {
        pdf_area * d * d / (cos * scene.lights().len() as f32)
    }

    fn trace(&self, scene: &Scene, ray: Ray, sampler: &mut Sampler) -> Vec<Vertex> {
        let mut vertices = Vec::new();
        let mut next = scene.intersect(&ray);
        let mut before: Option<(Vec3, f32)> = None;
        while let Some(hit) = next.take() {
            let bounces_left = self.settings.max_bounces as usize - vertices.len();
            let mut vertex = Vertex { emitted: self.emitted(scene, &hit, before), direct: Rgb::BLACK, bounce: Rgb::BLACK };
            if bounces_left > 0 {
                let bsdf = hit.bsdf();
                if self.settings.technique != Technique::Bsdf && !bsdf.is_delta() {
                    vertex.direct = self.direct(scene, &hit, &bsdf, sampler).unwrap_or(Rgb::BLACK);
                }
                let survival = if vertices.len() < 4 { 1.0 } else { 0.85 };
                if let Some(sample) = bsdf.sample(sampler)
                    && sampler.next_1d() < survival
                {
                    vertex.bounce = sample.f * (sample.cos / (sample.pdf * survival));
                    before = if sample.is_delta { None } else { Some((hit.point, sample.pdf)) };
                    next = scene.intersect(&hit.spawn(sample.wi));
                }
            }
            vertices.push(vertex);
        }
        vertices
    }

    fn emitted(&self, scene: &Scene, hit: &Hit, before: Option<(Vec3, f32)>) -> Rgb {
        let Some(emission) = hit.emission() else { return Rgb::BLACK };
        let weight = match (before, self.settings.technique) {
            (None, _) | (_, Technique::Bsdf) => 1.0,
            (_, Technique::Nee) => 0.0,
            (Some((point, p_brdf)), Technique::Mis) => {
                let d = point.distance(hit.point);
                let p_ne = Self::solid_angle(scene, emission.pdf_area, emission.cos_light, d);
                1.0 / (1.0 + p_ne / p_brdf)
            }
        };
        emission.radiance * weight
    }

    fn direct(&self, scene: &Scene, hit: &Hit, bsdf: &Bsdf, sampler: &mut Sampler) -> Option<Rgb> {
        let index = (sampler.next_1d() * scene.lights().len() as f32) as usize;
        let light = scene.lights().get(index)?;
        let sample = light.sample_direct(hit.point, sampler)?;
        let (wi, d) = direction_and_distance(hit.point, sample.point);
        let p_ne = Self::solid_angle(scene, sample.pdf_area, sample.cos_light, d);
        let is_mis = self.settings.technique == Technique::Mis && light.has_area();
        let weight = if is_mis { 1.0 / (1.0 + bsdf.pdf(wi) / p_ne) } else { 1.0 };
        let light = bsdf.eval(wi) * sample.emitted * (hit.cos(wi) * weight / p_ne);
        (!scene.occluded(hit, sample.point)).then_some(light)
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, scene: &Scene, ray: Ray, sampler: &mut Sampler) -> Rgb {
        let vertices = self.trace(scene, ray, sampler);
        vertices.iter().rev().fold(Rgb::BLACK, |arriving, vertex| {
            vertex.emitted + vertex.direct + vertex.bounce * arriving
        })
    }
}
