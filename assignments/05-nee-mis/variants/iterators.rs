use arty::prelude::*;

pub struct PathTracer {
    technique: Technique,
    max_bounces: u32,
}

impl PathTracer {
    pub fn new(Settings { technique, max_bounces }: Settings) -> Self {
        Self { technique, max_bounces }
    }
}

/// A point of the path: its ray, its throughput, and where a density stands against the light sample's.
struct Vertex {
    ray: Ray,
    throughput: Rgb,
    rival: Option<(Vec3, f32)>,
}

impl Integrator for PathTracer {
    fn radiance(&self, scene: &Scene, ray: Ray, sampler: &mut Sampler) -> Rgb {
        let count = scene.lights().len() as f32;
        let start = Some(Vertex { ray, throughput: Rgb::WHITE, rival: None });
        (0..=self.max_bounces)
            .scan(start, |state, bounce| {
                let Vertex { ray, throughput, rival } = state.take()?;
                let hit = scene.intersect(&ray)?;
                let bsdf = hit.bsdf();
                let found = hit
                    .emission()
                    .map(|emission| {
                        let share = rival.map_or(1.0, |(from, pdf)| match self.technique {
                            Technique::Bsdf => 1.0,
                            Technique::Nee => 0.0,
                            Technique::Mis => {
                                let squared = from.distance_squared(hit.point);
                                pdf / (pdf + emission.pdf_area * squared / (emission.cos_light * count))
                            }
                        });
                        emission.radiance * share
                    })
                    .unwrap_or(Rgb::BLACK);
                if bounce == self.max_bounces {
                    return Some(throughput * found);
                }
                let asked = (self.technique != Technique::Bsdf)
                    .then(|| sampler.next_1d() * count)
                    .and_then(|pick| scene.lights().get(pick as usize))
                    .and_then(|light| Some((light, light.sample_direct(hit.point, sampler)?)))
                    .filter(|(_, sample)| !scene.occluded(&hit, sample.point))
                    .map(|(light, sample)| {
                        let (wi, distance) = direction_and_distance(hit.point, sample.point);
                        let p_ne = sample.pdf_area * distance * distance / (sample.cos_light * count);
                        let against = light.has_area() && self.technique == Technique::Mis;
                        let p_brdf = if against { bsdf.pdf(wi) } else { 0.0 };
                        // The balance heuristic's weight, divided by p_ne.
                        bsdf.eval(wi) * sample.emitted * (hit.cos(wi) / (p_ne + p_brdf))
                    })
                    .unwrap_or(Rgb::BLACK);
                *state = bsdf.sample(sampler).map(|sample| Vertex {
                    ray: hit.spawn(sample.wi),
                    throughput: throughput * sample.f * (sample.cos / sample.pdf),
                    rival: (!sample.is_delta).then_some((hit.point, sample.pdf)),
                });
                Some(throughput * (found + asked))
            })
            .fold(Rgb::BLACK, |sum, contribution| sum + contribution)
    }
}
