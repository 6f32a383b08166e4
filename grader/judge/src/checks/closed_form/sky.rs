//! Light from an environment that nothing occludes.

use std::collections::HashMap;

use arty::environment::Environment;
use arty::math::Vec3;
use arty::scene::{Hit, SceneDescription};
use glam::DVec3;
use verdict::check::WhyNot;

/// Minimum number of rows and columns of the quadrature: its relative error is then 2e-5.
const ROWS: usize = 256;
const COLUMNS: usize = 512;

/// Part of the scene's size by which a corner may be above the plane of a face that it belongs to.
const FLAT: f64 = 1e-5;

/// The environment of a scene, for convex bodies: nothing is above the plane of any of their faces.
pub(super) struct Sky<'a> {
    environment: &'a Environment,
    patches: Vec<Patch>,
    corners: Vec<DVec3>,
    size: f64,
    faces: HashMap<[u32; 3], Face>,
}

/// A direction from which light arrives, and what arrives from around it: radiance times solid angle.
struct Patch {
    direction: DVec3,
    radiance: [f64; 3],
}

/// All that depends on a normal only.
#[derive(Clone, Copy)]
struct Face {
    /// Distance from the origin, along the normal, of the corner that is farthest.
    reach: f64,
    irradiance: [f64; 3],
}

impl<'a> Sky<'a> {
    pub(super) fn new(environment: &'a Environment, description: &SceneDescription) -> Self {
        let corners: Vec<DVec3> = description
            .meshes
            .iter()
            .flat_map(|mesh| &mesh.positions)
            .map(|corner| corner.as_dvec3())
            .collect();
        let size = corners.iter().map(|corner| corner.distance(corners[0])).fold(0.0, f64::max);
        Self { environment, patches: patches(environment), corners, size, faces: HashMap::new() }
    }

    /// Radiance of the background.
    pub(super) fn seen(&self, direction: Vec3) -> [f64; 3] {
        self.environment.radiance(direction).to_array().map(f64::from)
    }

    /// Irradiance of the surface at a hit.
    ///
    /// # Errors
    /// If something is above its plane.
    pub(super) fn irradiance(&mut self, hit: &Hit<'_>) -> Result<[f64; 3], WhyNot> {
        let normal = hit.normal.as_dvec3();
        let key = hit.normal.to_array().map(f32::to_bits);
        let face = *self.faces.entry(key).or_insert_with(|| Face {
            reach: self.corners.iter().map(|corner| normal.dot(*corner)).fold(f64::NEG_INFINITY, f64::max),
            irradiance: irradiance(&self.patches, normal),
        });
        let is_convex = face.reach - normal.dot(hit.point.as_dvec3()) <= FLAT * self.size;
        if is_convex { Ok(face.irradiance) } else { Err(WhyNot::PartlyHidden) }
    }
}

/// The quadrature: texels, divided into parts where they are few. Radiance is constant in each.
fn patches(environment: &Environment) -> Vec<Patch> {
    use std::f64::consts::{PI, TAU};
    let (columns, rows) = (environment.width(), environment.height());
    let (across, down) = (COLUMNS.div_ceil(columns), ROWS.div_ceil(rows));
    let mut patches = Vec::new();
    for row in 0..rows * down {
        let polar = |row: f64| PI * row / (rows * down) as f64;
        // cos θ₀ − cos θ₁ of the borders, without its cancellation.
        let height = 2.0 * polar(row as f64 + 0.5).sin() * (0.5 * polar(1.0)).sin();
        let solid_angle = height * TAU / (columns * across) as f64;
        for column in 0..columns * across {
            let texel = environment.texel(column / across, row / down);
            if texel.is_black() {
                continue;
            }
            let u = (column as f64 + 0.5) / (columns * across) as f64;
            let v = (row as f64 + 0.5) / (rows * down) as f64;
            patches.push(Patch {
                direction: environment.direction(u as f32, v as f32).as_dvec3(),
                radiance: texel.to_array().map(|channel| f64::from(channel) * solid_angle),
            });
        }
    }
    patches
}

/// E(n) = ∫ L(ω) max(n·ω, 0) dω.
fn irradiance(patches: &[Patch], normal: DVec3) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for patch in patches {
        let cos = normal.dot(patch.direction).max(0.0);
        (0..3).for_each(|channel| sum[channel] += patch.radiance[channel] * cos);
    }
    sum
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use arty::math::Rgb;
    use glam::Quat;

    use super::*;

    /// A map of radiances that are a function of the direction at the centre of each texel.
    fn map(width: usize, height: usize, turn: Quat, radiance: impl Fn(DVec3) -> [f64; 3]) -> Environment {
        // Orientation comes from the documentation, not from `Environment`.
        let direction = |column: usize, row: usize| {
            let azimuth = 2.0 * PI * ((column as f64 + 0.5) / width as f64 - 0.5);
            let polar = PI * (row as f64 + 0.5) / height as f64;
            DVec3::new(polar.sin() * azimuth.sin(), polar.cos(), -polar.sin() * azimuth.cos())
        };
        let texel = |index: usize| {
            let [r, g, b] = radiance(direction(index % width, index / width));
            Rgb::new(r as f32, g as f32, b as f32)
        };
        Environment::new(width, height, (0..width * height).map(texel).collect(), turn)
    }

    /// The irradiance of a + Y, where Y is a spherical harmonic of degree 0, 1 or 2, is π a + A Y(normal) with A = π, 2π/3,
    /// π/4 (Ramamoorthi and Hanrahan, "An Efficient Representation for Irradiance Environment Maps", 2001).
    #[test]
    fn spherical_harmonics_have_their_factors() {
        let axis = DVec3::new(0.6, 0.0, 0.8);
        let harmonics = |w: DVec3| [0.5, w.dot(axis), w.x * w.y + 0.5 * (3.0 * w.z * w.z - 1.0)];
        let turn = Quat::from_axis_angle(Vec3::new(0.48, -0.6, 0.64), 2.3);
        let environment = map(256, 128, turn, |w| harmonics(w).map(|value| value + 1.5));
        let patches = patches(&environment);
        for normal in [DVec3::Y, DVec3::NEG_Y, axis, DVec3::new(-0.48, -0.6, 0.64)] {
            let found = irradiance(&patches, normal);
            let harmonic = harmonics(turn.conjugate().as_dquat() * normal);
            for (channel, factor) in [PI, 2.0 * PI / 3.0, PI / 4.0].into_iter().enumerate() {
                let exact = 1.5 * PI + factor * harmonic[channel];
                assert!(
                    (found[channel] / exact - 1.0).abs() < 2e-4,
                    "degree {channel}, {normal}: {} {exact}",
                    found[channel]
                );
            }
        }
    }

    /// A disk of angular radius α around a direction at the angle θ to the normal: E = π L sin² α cos θ.
    #[test]
    fn a_sun_has_its_irradiance() {
        let environment =
            map(7, 45, Quat::IDENTITY, |w| [if w.y > (PI * 2.0 / 45.0).cos() { 100.0 } else { 0.0 }; 3]);
        let sin2 = (PI * 2.0 / 45.0).sin().powi(2);
        for normal in [DVec3::Y, DVec3::new(0.48, 0.6, -0.64)] {
            let found = irradiance(&patches(&environment), normal)[0];
            assert!((found / (PI * 100.0 * sin2 * normal.y) - 1.0).abs() < 2e-4, "{normal}: {found}");
        }
    }
}
