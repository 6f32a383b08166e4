//! From recorded calls to the vertices of a path.
//!
//! Nothing is known about the code that made the calls: it may skip some, repeat them, or make them in another order. So a
//! vertex shows what the framework answered, and what light would add by the formulas of the sheet, given these answers.

use arty::integrator::Technique;
use arty::math::{Rgb, Vec3};

use super::calls::{Call, RecordedPath};

/// A path through the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    /// Number of the sample.
    pub sample: u64,
    /// Origin of the first ray.
    pub origin: Vec3,
    /// The hit points, in order.
    pub vertices: Vec<Vertex>,
    /// Direction of the last ray, if it left the scene.
    pub escaped: Option<Vec3>,
    /// True if a random number was drawn between two bounces, as for Russian roulette. Its effect on the throughput is
    /// not known.
    pub roulette: bool,
    /// What the integrator returned.
    pub returned: Rgb,
}

/// A hit point.
#[derive(Clone, Debug, PartialEq)]
pub struct Vertex {
    /// The point, in world space.
    pub point: Vec3,
    normal: Vec3,
    /// Product of f · cos / pdf over the bounces before, without Russian roulette.
    pub throughput: Rgb,
    /// Emission of the light that was hit here, if the integrator asked for it.
    pub emission: Option<Found>,
    /// Light samples taken here.
    pub light_samples: Vec<LightSample>,
}

/// A point on a light that was sampled, and the shadow ray to it.
#[derive(Clone, Debug, PartialEq)]
pub struct LightSample {
    /// The point, in world space.
    pub point: Vec3,
    /// Whether the shadow ray arrived; `None` if none was traced.
    pub arrives: Option<bool>,
    /// What it adds.
    pub found: Found,
}

/// Light, with the densities of both ways to find it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    /// Index of the light.
    pub light: usize,
    /// Density of the direction in next event estimation, per solid angle, with lights picked uniformly.
    pub p_ne: Option<f32>,
    /// Density of the direction in BSDF sampling, per solid angle. `None` if BSDF sampling cannot find this light, or if the
    /// integrator did not ask for the density.
    pub p_brdf: Option<f32>,
    /// Weight of the technique: that of the balance heuristic for `mis`.
    pub weight: f32,
    /// What it adds to the radiance.
    pub contribution: Rgb,
}

/// What is known of the lights of a scene: for each whether it has an area.
pub type Areas<'a> = &'a [bool];

impl Path {
    /// The vertices of a recorded path.
    pub fn new(recorded: &RecordedPath, technique: Technique, lights: Areas<'_>) -> Self {
        let path = Self {
            sample: recorded.sample,
            origin: Vec3::ZERO,
            vertices: Vec::new(),
            escaped: None,
            roulette: false,
            returned: recorded.radiance,
        };
        let mut walk = Walk { path, technique, lights, throughput: Rgb::WHITE, bounce: None, open: None };
        recorded.calls.iter().for_each(|call| walk.take(call));
        walk.path.vertices.iter_mut().for_each(|vertex| vertex.close_samples(technique, lights));
        walk.path
    }

    /// The sum of all that is added along the path, without Russian roulette.
    pub fn sum(&self) -> Rgb {
        let of_vertex = |vertex: &Vertex| {
            let samples = vertex.light_samples.iter().map(|sample| sample.found.contribution);
            vertex
                .emission
                .iter()
                .map(|found| found.contribution)
                .chain(samples)
                .fold(Rgb::BLACK, |a, b| a + b)
        };
        self.vertices.iter().map(of_vertex).fold(Rgb::BLACK, |a, b| a + b)
    }
}

/// The last bounce: direction, density, whether it was a delta bounce.
struct Bounce {
    from: Vec3,
    wi: Vec3,
    pdf: f32,
    is_delta: bool,
}

struct Walk<'a> {
    path: Path,
    technique: Technique,
    lights: Areas<'a>,
    throughput: Rgb,
    bounce: Option<Bounce>,
    /// Direction to the last light sample of the last vertex.
    open: Option<Vec3>,
}

impl Walk<'_> {
    fn take(&mut self, call: &Call) {
        match call.function {
            "Scene::intersect" => self.intersect(call),
            "Hit::emission" => self.emission(call),
            "Light::sample_direct" => self.light_sample(call),
            "Scene::occluded" => {
                let arrives = call.number("occluded").map(|occluded| occluded == 0.0);
                if let Some(sample) = self.sample() {
                    sample.arrives = arrives;
                }
            }
            "Bsdf::eval" if self.is_open(call) => {
                let f = call.color("f").unwrap_or(Rgb::BLACK);
                // It may be evaluated twice.
                if let Some(sample) = self.sample().filter(|sample| sample.found.weight == 0.0) {
                    sample.found.contribution *= f;
                    sample.found.weight = 1.0;
                }
            }
            "Bsdf::pdf" if self.is_open(call) => {
                let pdf = call.number("pdf");
                if let Some(sample) = self.sample() {
                    sample.found.p_brdf = pdf;
                }
            }
            "Bsdf::sample" => self.bounce(call),
            "Sampler::next_1d" if self.bounce.is_some() => self.path.roulette |= self.after_bounce(),
            _ => {}
        }
    }

    fn sample(&mut self) -> Option<&mut LightSample> {
        self.path.vertices.last_mut()?.light_samples.last_mut()
    }

    /// True if a call concerns the direction of the last light sample.
    fn is_open(&self, call: &Call) -> bool {
        let along = |open: Vec3| call.given("wi").is_some_and(|wi| wi.dot(open) > 0.999);
        self.open.is_some_and(along)
    }

    /// True if the next ray of the path has not been traced yet since the last bounce.
    fn after_bounce(&self) -> bool {
        let here = self.path.vertices.last().map(|vertex| vertex.point);
        self.bounce.as_ref().is_some_and(|bounce| Some(bounce.from) == here)
    }

    fn intersect(&mut self, call: &Call) {
        let Some(direction) = call.given("direction") else { return };
        if self.path.vertices.is_empty() {
            self.path.origin = call.given("origin").unwrap_or(Vec3::ZERO);
        } else if self.bounce.as_ref().is_none_or(|bounce| bounce.wi != direction) {
            // Not the next ray of the path: a shadow ray that looks at what it hits.
            let light = call.number("light").map(|light| light as usize);
            if let Some(sample) = self.sample() {
                sample.arrives = Some(light == Some(sample.found.light));
            }
            return;
        }
        self.open = None;
        match call.vector("point") {
            None => self.path.escaped = Some(direction),
            Some(point) => self.path.vertices.push(Vertex {
                point,
                normal: call.vector("normal").unwrap_or(-direction),
                throughput: self.throughput,
                emission: None,
                light_samples: Vec::new(),
            }),
        }
    }

    fn emission(&mut self, call: &Call) {
        let (technique, throughput, count) = (self.technique, self.throughput, self.lights.len() as f32);
        // Neither the camera nor a delta bounce could have been replaced by a light sample.
        let bounce = self.bounce.as_ref().filter(|bounce| !bounce.is_delta);
        let bounce = bounce.map(|bounce| (bounce.from, bounce.pdf));
        let Some(vertex) = self.path.vertices.last_mut() else { return };
        let radiance = call.color("radiance").unwrap_or(Rgb::BLACK);
        let p_ne = bounce.and_then(|(from, _)| density(call, from, vertex.point, count));
        let p_brdf = bounce.map(|(_, pdf)| pdf);
        let weight = match (technique, p_brdf, p_ne) {
            (Technique::Nee, Some(_), _) => 0.0,
            (Technique::Mis, Some(own), Some(other)) => own / (own + other),
            (Technique::Bsdf | Technique::Nee | Technique::Mis, ..) => 1.0,
        };
        let light = call.number("light").unwrap_or(0.0) as usize;
        let contribution = throughput * radiance * weight;
        vertex.emission = Some(Found { light, p_ne, p_brdf, weight, contribution });
    }

    fn light_sample(&mut self, call: &Call) {
        let (light, count) = (find_light(call), self.lights.len() as f32);
        let Some(vertex) = self.path.vertices.last_mut() else { return };
        let (Some(point), Some(emitted)) = (call.vector("point"), call.color("emitted")) else { return };
        let wi = (point - vertex.point).normalize_or_zero();
        let p_ne = density(call, vertex.point, point, count);
        let cos = vertex.normal.dot(wi).abs();
        // Complete when the value of the BSDF is known.
        let contribution = p_ne.map_or(Rgb::BLACK, |p_ne| vertex.throughput * emitted * (cos / p_ne));
        let found = Found { light, p_ne, p_brdf: None, weight: 0.0, contribution };
        vertex.light_samples.push(LightSample { point, arrives: None, found });
        self.open = Some(wi);
    }

    fn bounce(&mut self, call: &Call) {
        let Some(from) = self.path.vertices.last().map(|vertex| vertex.point) else { return };
        self.open = None;
        let (Some(wi), Some(f)) = (call.vector("wi"), call.color("f")) else { return };
        let (Some(cos), Some(pdf)) = (call.number("cos"), call.number("pdf")) else { return };
        self.throughput *= f * (cos / pdf);
        self.bounce = Some(Bounce { from, wi, pdf, is_delta: call.number("is_delta") == Some(1.0) });
    }
}

impl Vertex {
    /// Weights light samples, once all calls that belong to them are known.
    fn close_samples(&mut self, technique: Technique, lights: Areas<'_>) {
        for LightSample { arrives, found, .. } in &mut self.light_samples {
            let has_area = lights.get(found.light).copied().unwrap_or(true);
            if technique == Technique::Mis
                && has_area
                && let (Some(own), Some(other)) = (found.p_ne, found.p_brdf)
            {
                found.weight *= own / (own + other);
            }
            let counts = if *arrives == Some(true) { found.weight } else { 0.0 };
            found.contribution *= counts;
        }
    }
}

/// The density per solid angle with which next event estimation samples the direction from one point to another on a light,
/// with lights picked uniformly (section 5.1 of the sheet).
fn density(call: &Call, from: Vec3, on_light: Vec3, lights: f32) -> Option<f32> {
    let (per_area, cos) = (call.number("pdf_area")?, call.number("cos_light")?);
    Some(per_area * from.distance_squared(on_light) / (cos * lights))
}

/// The index of the light that was sampled.
fn find_light(call: &Call) -> usize {
    let index = call.given.iter().find(|(name, _)| *name == "light").and_then(|(_, numbers)| numbers.first());
    index.map_or(0, |index| *index as usize)
}

#[cfg(test)]
mod tests;
