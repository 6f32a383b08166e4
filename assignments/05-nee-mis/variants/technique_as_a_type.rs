use arty::prelude::*;

/// How the two ways of finding light are weighted.
trait Weighting {
    const SAMPLES_LIGHTS: bool;
    /// Weight of a light sample with these densities.
    fn of_light_sample(p_light: f32, p_brdf: f32) -> f32;
    /// Weight of a hit with these densities.
    fn of_hit(p_brdf: f32, p_light: f32) -> f32;
}

struct BsdfOnly;
struct NextEvent;
struct Balanced;

impl Weighting for BsdfOnly {
    const SAMPLES_LIGHTS: bool = false;
    fn of_light_sample(_: f32, _: f32) -> f32 {
        0.0
    }
    fn of_hit(_: f32, _: f32) -> f32 {
        1.0
    }
}

impl Weighting for NextEvent {
    const SAMPLES_LIGHTS: bool = true;
    fn of_light_sample(_: f32, _: f32) -> f32 {
        1.0
    }
    fn of_hit(_: f32, p_light: f32) -> f32 {
        if p_light > 0.0 { 0.0 } else { 1.0 }
    }
}

impl Weighting for Balanced {
    const SAMPLES_LIGHTS: bool = true;
    fn of_light_sample(p_light: f32, p_brdf: f32) -> f32 {
        1.0 / (1.0 + p_brdf / p_light)
    }
    fn of_hit(p_brdf: f32, p_light: f32) -> f32 {
        1.0 / (1.0 + p_light / p_brdf)
    }
}

pub struct PathTracer {
    settings: Settings,
}

impl PathTracer {
    pub fn new(settings: Settings) -> Self {
        PathTracer { settings }
    }

    fn walk<W: Weighting>(&self, scene: &Scene, mut ray: Ray, sampler: &mut Sampler) -> Rgb {
        let count = scene.lights().len() as f32;
        let per_solid_angle = |pdf_area: f32, cos: f32, from: Vec3, to: Vec3| {
            pdf_area * from.distance_squared(to) / (cos * count)
        };
        let (mut sum, mut beta) = (Rgb::BLACK, Rgb::WHITE);
        // Density of the last bounce and where it was; None where no light sample could have taken its place.
        let mut last: Option<(f32, Vec3)> = None;
        let mut bounces = 0;
        loop {
            let Some(hit) = scene.intersect(&ray) else { return sum };
            if let Some(light) = hit.emission() {
                let weight = match last {
                    None => 1.0,
                    Some((p_brdf, from)) => {
                        W::of_hit(p_brdf, per_solid_angle(light.pdf_area, light.cos_light, from, hit.point))
                    }
                };
                sum += beta * light.radiance * weight;
            }
            if bounces == self.settings.max_bounces {
                return sum;
            }
            bounces += 1;
            let bsdf = hit.bsdf();
            if W::SAMPLES_LIGHTS && !bsdf.is_delta() {
                let pick = (sampler.next_1d() * count) as usize;
                let light = scene.lights().get(pick);
                if let Some((light, it)) = light.and_then(|light| Some((light, light.sample_direct(hit.point, sampler)?)))
                    && !scene.occluded(&hit, it.point)
                {
                    let (wi, _) = direction_and_distance(hit.point, it.point);
                    let p = per_solid_angle(it.pdf_area, it.cos_light, hit.point, it.point);
                    let p_brdf = if light.has_area() { bsdf.pdf(wi) } else { 0.0 };
                    sum += beta * bsdf.eval(wi) * it.emitted * (hit.cos(wi) * W::of_light_sample(p, p_brdf) / p);
                }
            }
            let Some(next) = bsdf.sample(sampler) else { return sum };
            beta *= next.f * (next.cos / next.pdf);
            if bounces > 4 {
                let q = beta.max_channel().clamp(0.02, 1.0);
                if sampler.next_1d() >= q {
                    return sum;
                }
                beta /= q;
            }
            last = (!next.is_delta).then_some((next.pdf, hit.point));
            ray = hit.spawn(next.wi);
        }
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, scene: &Scene, ray: Ray, sampler: &mut Sampler) -> Rgb {
        match self.settings.technique {
            Technique::Bsdf => self.walk::<BsdfOnly>(scene, ray, sampler),
            Technique::Nee => self.walk::<NextEvent>(scene, ray, sampler),
            Technique::Mis => self.walk::<Balanced>(scene, ray, sampler),
        }
    }
}
