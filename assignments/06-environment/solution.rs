//! Exercise 6: light from the environment.
//!
//! This is the path tracer of the previous sheet. It knows the lights of a scene, but not its environment. Complete the
//! places marked `TASK … END`:
//!
//! - `EnvironmentSampler` (6.1) samples directions in proportion to the light that arrives from them: build its tables,
//!   then `sample` and `pdf`;
//! - `PathTracer` (6.2) finds that light as its technique says: `bsdf` where a ray leaves the scene, `nee` by sampling
//!   the environment as one more light, `mis` by both with the balance heuristic.
//!
//! This file is your submission. You may change it as you like, add functions and types, and use `std` and
//! `arty::prelude`, as long as it defines `PathTracer` and `EnvironmentSampler` with the functions below. `cargo api`
//! shows the documentation of the prelude.

use arty::prelude::*;

/// Samples directions with a density proportional to the luminance of an environment.
pub struct EnvironmentSampler {
    // TASK 6.1: what do `sample` and `pdf` need?
    /// For each row, the probability of the rows before it; then 1.
    rows: Vec<f64>,
    /// For each texel, row by row, the probability within its row of the texels before it; each row ends with a 1.
    columns: Vec<f64>,
    /// The luminance that arrives from all directions together: its integral over the sphere.
    total: f64,
    // END 6.1
}

impl EnvironmentSampler {
    /// Builds the tables, once for each scene.
    pub fn new(environment: &Environment) -> Self {
        // TASK 6.1: the probability of a texel is proportional to its luminance times its solid angle.
        let (width, height) = (environment.width(), environment.height());
        let mut rows = Vec::with_capacity(height + 1);
        let mut columns = Vec::with_capacity(height * (width + 1));
        for row in 0..height {
            let start = columns.len();
            let luminance = |column| f64::from(environment.texel(column, row).luminance());
            cumulate((0..width).map(luminance), &mut columns);
            rows.push(columns[start..].last().copied().unwrap_or(0.0) * solid_angle(width, height, row));
            normalize(&mut columns[start..]);
        }
        let weights = std::mem::take(&mut rows);
        cumulate(weights.into_iter(), &mut rows);
        let total = normalize(&mut rows);
        Self { rows, columns, total }
        // END 6.1
    }
}

impl SampleDirections for EnvironmentSampler {
    /// Samples a direction towards the environment. `None` if no light arrives from it.
    fn sample(&self, environment: &Environment, sampler: &mut Sampler) -> Option<DirectionSample> {
        // TASK 6.1: select a texel, then a direction in it.
        if self.total == 0.0 {
            return None;
        }
        let (width, height) = (environment.width(), environment.height());
        let (to_row, to_column) = sampler.next_2d();
        let (row, along_row) = find(&self.rows, to_row);
        let start = row * (width + 1);
        let (column, along_column) = find(&self.columns[start..=start + width], to_column);

        // Uniform in the texel's solid angle: in the azimuth, and in the cosine of the polar angle.
        let (top, bottom) = (polar_angle(height, row).cos(), polar_angle(height, row + 1).cos());
        let polar = (top + along_row * (bottom - top)).clamp(-1.0, 1.0).acos();
        let u = (column as f64 + along_column) / width as f64;
        let wi = environment.direction(u as f32, (polar / std::f64::consts::PI) as f32);
        // A direction next to the border of its texel may be rounded to the next one, which may be black.
        let pdf = self.pdf(environment, wi);
        (pdf > 0.0).then_some(DirectionSample { wi, pdf })
        // END 6.1
    }

    /// The density per solid angle with which `sample` samples the direction `wi`.
    fn pdf(&self, environment: &Environment, wi: Vec3) -> f32 {
        // TASK 6.1: it has to be the density of `sample`, for every direction.
        if self.total == 0.0 {
            return 0.0;
        }
        (f64::from(environment.radiance(wi).luminance()) / self.total) as f32
        // END 6.1
    }
}

// TASK 6.1: if you want functions of your own, they can go here.
/// The polar angle at the upper border of a row, from the direction up.
fn polar_angle(height: usize, row: usize) -> f64 {
    row as f64 / height as f64 * std::f64::consts::PI
}

/// The solid angle of each texel of a row.
fn solid_angle(width: usize, height: usize, row: usize) -> f64 {
    let (top, bottom) = (polar_angle(height, row), polar_angle(height, row + 1));
    // cos top − cos bottom, without its cancellation at the poles.
    let difference = 2.0 * (0.5 * (top + bottom)).sin() * (0.5 * (bottom - top)).sin();
    difference * std::f64::consts::TAU / width as f64
}

/// Appends the sums of the weights before each of them, then the sum of all.
fn cumulate(weights: impl Iterator<Item = f64>, sums: &mut Vec<f64>) {
    let mut sum = 0.0;
    sums.push(sum);
    for weight in weights {
        sum += weight;
        sums.push(sum);
    }
}

/// Divides sums by the last, which is returned; leaves them if it is 0.
fn normalize(sums: &mut [f64]) -> f64 {
    let total = sums.last().copied().unwrap_or(0.0);
    if total > 0.0 {
        sums.iter_mut().for_each(|sum| *sum /= total);
    }
    total
}

/// The index that a random number in [0, 1) selects, and where in [0, 1) it lies within its share.
fn find(sums: &[f64], random: f32) -> (usize, f64) {
    let random = f64::from(random);
    // The last one that begins at or before the number: of empty ones at the same place, the last is not empty.
    let index = sums.partition_point(|&sum| sum <= random).saturating_sub(1).min(sums.len() - 2);
    let share = sums[index + 1] - sums[index];
    (index, if share > 0.0 { (random - sums[index]) / share } else { 0.5 })
}
// END 6.1

/// First bounce at which Russian roulette applies.
const ROULETTE_START: u32 = 5;

/// A path tracer: follows one path from the camera and sums the light found along it.
pub struct PathTracer {
    settings: Settings,
    /// `None` for a scene without an environment.
    environment_sampler: Option<EnvironmentSampler>,
}

impl PathTracer {
    /// A path tracer for a scene, with the given technique and maximum number of bounces.
    pub fn new(settings: Settings, scene: &Scene) -> Self {
        Self { settings, environment_sampler: scene.environment().map(EnvironmentSampler::new) }
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, scene: &Scene, mut ray: Ray, sampler: &mut Sampler) -> Rgb {
        // The light found so far, and the throughput: the product of f · cos / pdf over all bounces.
        let mut radiance = Rgb::BLACK;
        let mut throughput = Rgb::WHITE;
        // None at the camera and after a delta bounce: no light sample could have taken its place.
        let mut last_bounce: Option<LastBounce> = None;

        for bounce in 0..=self.settings.max_bounces {
            let Some(hit) = scene.intersect(&ray) else {
                // 1. Add the light of the environment, if the ray has left the scene.
                radiance += throughput * self.escaped(scene, &ray, last_bounce);
                break;
            };

            // 2. Add the emission of the light that the path has hit, if it has hit one.
            if let Some(emission) = hit.emission() {
                let weight = self.emission_weight(scene, &hit, &emission, last_bounce);
                radiance += throughput * emission.radiance * weight;
            }
            if bounce == self.settings.max_bounces {
                break;
            }

            // 3. Add direct light by next event estimation.
            let bsdf = hit.bsdf();
            if self.settings.technique != Technique::Bsdf && !bsdf.is_delta() {
                radiance += throughput * self.direct_light(scene, &hit, &bsdf, sampler);
            }

            // 4. Sample the BSDF for the direction of the next ray.
            let Some(sample) = bsdf.sample(sampler) else { break };
            throughput *= sample.f * (sample.cos / sample.pdf);
            last_bounce = (!sample.is_delta).then_some(LastBounce { point: hit.point, p_brdf: sample.pdf });

            // 5. Russian roulette: the lower the throughput, the more likely the path ends.
            if bounce + 1 >= ROULETTE_START {
                let survival = throughput.max_channel().min(0.95);
                if sampler.next_1d() >= survival {
                    break;
                }
                throughput /= survival;
            }
            ray = hit.spawn(sample.wi);
        }
        radiance
    }
}

/// What the weight of light at the end of a ray depends on.
#[derive(Clone, Copy)]
struct LastBounce {
    /// The hit point where the path bounced, in world space.
    point: Vec3,
    /// Density per solid angle with which the direction was sampled.
    p_brdf: f32,
}

impl PathTracer {
    /// The light that a ray finds which has left the scene, with its weight for the technique.
    fn escaped(&self, scene: &Scene, ray: &Ray, last_bounce: Option<LastBounce>) -> Rgb {
        // TASK 6.2a, 6.2b, 6.2c: how much of the environment's light counts, given that next event estimation could have found it?
        let (Some(environment), Some(environment_sampler)) = (scene.environment(), &self.environment_sampler)
        else {
            return Rgb::BLACK;
        };
        let radiance = environment.radiance(ray.direction);
        match (self.settings.technique, last_bounce) {
            (_, None) | (Technique::Bsdf, _) => radiance,
            (Technique::Nee, _) => Rgb::BLACK,
            (Technique::Mis, Some(last_bounce)) => {
                let p_ne = p_light(scene) * environment_sampler.pdf(environment, ray.direction);
                radiance * balance(last_bounce.p_brdf, p_ne)
            }
        }
        // END 6.2a, 6.2b, 6.2c
    }

    /// Next event estimation: an estimate of the direct light that `hit` reflects towards the viewer, from one light,
    /// with its weight for the technique.
    fn direct_light(&self, scene: &Scene, hit: &Hit, bsdf: &Bsdf, sampler: &mut Sampler) -> Rgb {
        let pick = sampler.next_1d() * number_of_lights(scene) as f32;
        match scene.lights().get(pick as usize) {
            Some(light) => self.light_from(light, scene, hit, bsdf, sampler),
            None => self.light_from_environment(scene, hit, bsdf, sampler),
        }
    }

    /// The contribution of the environment, from one direction sampled by `EnvironmentSampler`.
    fn light_from_environment(&self, scene: &Scene, hit: &Hit, bsdf: &Bsdf, sampler: &mut Sampler) -> Rgb {
        // TASK 6.2b, 6.2c: sample a direction, and trace a single shadow ray.
        let (Some(environment), Some(environment_sampler)) = (scene.environment(), &self.environment_sampler)
        else {
            return Rgb::BLACK;
        };
        let Some(DirectionSample { wi, pdf }) = environment_sampler.sample(environment, sampler) else {
            return Rgb::BLACK;
        };
        let f = bsdf.eval(wi);
        if f.is_black() || scene.occluded_towards(hit, wi) {
            return Rgb::BLACK;
        }
        let p_ne = p_light(scene) * pdf;
        f * environment.radiance(wi) * (hit.cos(wi) * self.light_weight(p_ne, bsdf.pdf(wi)) / p_ne)
        // END 6.2b, 6.2c
    }

    /// The contribution of one light of the scene, from a random point on it.
    fn light_from(&self, light: &Light, scene: &Scene, hit: &Hit, bsdf: &Bsdf, sampler: &mut Sampler) -> Rgb {
        let Some(sample) = light.sample_direct(hit.point, sampler) else { return Rgb::BLACK };
        let (wi, distance) = direction_and_distance(hit.point, sample.point);
        let f = bsdf.eval(wi);
        if f.is_black() || scene.occluded(hit, sample.point) {
            return Rgb::BLACK;
        }
        let p_ne = p_light(scene) * sample.pdf_area * distance * distance / sample.cos_light;
        // No path ever hits a light without an area.
        let weight = if light.has_area() { self.light_weight(p_ne, bsdf.pdf(wi)) } else { 1.0 };
        f * sample.emitted * (hit.cos(wi) * weight / p_ne)
    }

    /// The weight of a light sample that a path could have found, too.
    fn light_weight(&self, p_ne: f32, p_brdf: f32) -> f32 {
        if self.settings.technique == Technique::Mis { balance(p_ne, p_brdf) } else { 1.0 }
    }

    /// The weight of the emission at `hit`: how much of it counts, given that next event estimation at the last bounce
    /// could have found the same light. 1 for the technique `bsdf`.
    fn emission_weight(
        &self,
        scene: &Scene,
        hit: &Hit,
        emission: &Emission,
        last_bounce: Option<LastBounce>,
    ) -> f32 {
        let Some(LastBounce { point, p_brdf }) = last_bounce else { return 1.0 };
        match self.settings.technique {
            Technique::Nee => 0.0,
            Technique::Bsdf => 1.0,
            Technique::Mis => {
                let (_, distance) = direction_and_distance(point, hit.point);
                let p_ne = p_light(scene) * emission.pdf_area * distance * distance / emission.cos_light;
                balance(p_brdf, p_ne)
            }
        }
    }
}

/// The number of lights that next event estimation selects from.
fn number_of_lights(scene: &Scene) -> usize {
    // TASK 6.2b, 6.2c: the environment is one more light.
    scene.lights().len() + usize::from(scene.environment().is_some())
    // END 6.2b, 6.2c
}

/// The selection probability: with which next event estimation picks each of the lights.
fn p_light(scene: &Scene) -> f32 {
    1.0 / number_of_lights(scene) as f32
}

/// The balance heuristic p / (p + q), where p is the density of the technique to be weighted. As a quotient of
/// densities it does not overflow where their sum would.
fn balance(p: f32, q: f32) -> f32 {
    1.0 / (1.0 + q / p)
}
