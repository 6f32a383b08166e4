//! Light from the environment: radiance that arrives from infinity, stored as an equirectangular map.
//!
//! Seen from inside, the map is a panorama with the direction −z in its centre, +x to the right of that, and +y, which is
//! up, along its upper edge:
//!
//! ```text
//!            u = 0         0.25         0.5         0.75          1
//!    v = 0     ┌─────────────────── +y (up) ────────────────────┐
//!              │                                                │
//!      0.5    +z           −x           −z           +x        +z
//!              │                                                │
//!        1     └────────────────── −y (down) ───────────────────┘
//! ```
//!
//! v is the angle from +y divided by π, u the azimuth divided by 2π. A unit of v is an angle of π, so a map has twice as
//! many columns as rows where its texels are about square. A rotation turns the map before it surrounds the scene.
//!
//! Texel (column, row) covers u in [column / width, (column + 1) / width) and v in [row / height, (row + 1) / height).
//! **Radiance is constant in each texel**: a lookup does not interpolate. So the radiance is a known function, and a
//! density that is exactly proportional to it exists: nothing that samples or tests it needs an approximation.

use std::f64::consts::{PI, TAU};

use glam::{Mat3, Quat};

use crate::math::{Rgb, Vec3};
use crate::probe::{self, Call};
use crate::sampler::Sampler;

/// The light that arrives from outside of a scene. `Scene::environment` returns it.
#[derive(Clone, Debug)]
pub struct Environment {
    width: usize,
    height: usize,
    /// Row by row from the top, each row from the left.
    texels: Vec<Rgb>,
    /// From world space to the space of the map.
    to_map: Mat3,
}

/// A direction towards the environment: the result of [`SampleDirections::sample`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionSample {
    /// The sampled unit direction, in world space, pointing away from the scene.
    pub wi: Vec3,
    /// Density per solid angle with which it was sampled, sr⁻¹; positive.
    pub pdf: f32,
}

/// Sampling of directions towards an environment, always the same one.
pub trait SampleDirections: Sync {
    /// Samples a direction. `None` if there is none from which light arrives; such a sample contributes nothing.
    ///
    /// All randomness comes from `sampler`: equal samplers give equal results.
    fn sample(&self, environment: &Environment, sampler: &mut Sampler) -> Option<DirectionSample>;

    /// The density per solid angle, sr⁻¹, with which [`sample`](Self::sample) samples the unit direction `wi` (world
    /// space).
    fn pdf(&self, environment: &Environment, wi: Vec3) -> f32;
}

/// The largest number below 1.
const BELOW_ONE: f32 = 1.0 - f32::EPSILON / 2.0;

impl Environment {
    /// A map of `width · height` texels, row by row from the top, turned by `rotation`, a unit quaternion.
    ///
    /// # Panics
    /// If the number of texels is another one, or zero.
    pub fn new(width: usize, height: usize, texels: Vec<Rgb>, rotation: Quat) -> Self {
        assert!(width * height > 0 && texels.len() == width * height, "a map of {width} x {height} texels");
        Self { width, height, texels, to_map: Mat3::from_quat(rotation.conjugate()) }
    }

    /// Radiance that arrives from the unit direction `direction` (world space, pointing away from the scene), W·sr⁻¹·m⁻².
    ///
    /// With (u, v) = [`uv`](Self::uv)`(direction)` it is that of the [`texel`](Self::texel) in column ⌊u · width⌋ and
    /// row ⌊v · height⌋, or in the last row where v is 1.
    #[inline]
    pub fn radiance(&self, direction: Vec3) -> Rgb {
        let (u, v) = self.uv(direction);
        // Since u < 1, the product rounds to less than the width.
        let column = (u * self.width as f32) as usize;
        let row = ((v * self.height as f32) as usize).min(self.height - 1);
        let radiance = self.texel(column, row);
        probe::record(|| recorded_radiance(direction, radiance));
        radiance
    }

    /// Number of columns, at least 1.
    #[inline]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Number of rows, at least 1.
    #[inline]
    pub fn height(&self) -> usize {
        self.height
    }

    /// Radiance in the texel of a column, counted from the left, and a row, counted from the top; finite and not negative.
    ///
    /// # Panics
    /// If there is no such texel.
    #[inline]
    pub fn texel(&self, column: usize, row: usize) -> Rgb {
        assert!(column < self.width, "column {column} of a map of width {}", self.width);
        self.texels[row * self.width + column]
    }

    /// Coordinates (u, v) in the map of a unit direction (world space): u in [0, 1), v in [0, 1]. Rounded to single
    /// precision once.
    #[inline]
    pub fn uv(&self, direction: Vec3) -> (f32, f32) {
        let map = (self.to_map * direction).as_dvec3();
        // Adding 0 turns −0 into 0: equal directions must have equal coordinates, at the poles, too.
        let (right, back) = (map.x + 0.0, map.z + 0.0);
        // From −z, positive towards +x. The angle from +y as an arc tangent: near the poles an arc cosine is inaccurate.
        let azimuth = right.atan2(0.0 - back);
        let polar = right.hypot(back).atan2(map.y);
        let u = 0.5 + azimuth / TAU;
        // The seam itself belongs to the first column. What rounds to it from the last column stays there.
        let u = if u >= 1.0 { 0.0 } else { (u as f32).min(BELOW_ONE) };
        (u, (polar / PI) as f32)
    }

    /// The unit direction (world space) of coordinates in the map, both in [0, 1]: the inverse of [`uv`](Self::uv).
    #[inline]
    pub fn direction(&self, u: f32, v: f32) -> Vec3 {
        let (sin_azimuth, cos_azimuth) = (TAU * (f64::from(u) - 0.5)).sin_cos();
        let (sin_polar, cos_polar) = (PI * f64::from(v)).sin_cos();
        let map = glam::DVec3::new(sin_polar * sin_azimuth, cos_polar, -sin_polar * cos_azimuth);
        self.to_map.transpose() * map.as_vec3()
    }
}

/// Not inlined, or every submission would compile it again.
fn recorded_radiance(direction: Vec3, radiance: Rgb) -> Call {
    Call::new("Environment::radiance").given("direction", direction).got("radiance", radiance)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Texel (column, row) has the radiance (column, row, 1).
    fn numbered(width: usize, height: usize, rotation: Quat) -> Environment {
        let texel = |index| Rgb::new((index % width) as f32, (index / width) as f32, 1.0);
        Environment::new(width, height, (0..width * height).map(texel).collect(), rotation)
    }

    fn turns() -> [Quat; 3] {
        [Quat::IDENTITY, Quat::from_rotation_y(1.1), Quat::from_axis_angle(Vec3::new(0.48, -0.6, 0.64), 2.3)]
    }

    #[test]
    fn the_axes_are_where_the_picture_shows_them() {
        let map = numbered(4, 2, Quat::IDENTITY);
        for (direction, uv) in [
            (Vec3::NEG_Z, (0.5, 0.5)),
            (Vec3::X, (0.75, 0.5)),
            (Vec3::NEG_X, (0.25, 0.5)),
            (Vec3::Z, (0.0, 0.5)),
        ] {
            assert_eq!(map.uv(direction), uv, "{direction}");
            assert!((map.direction(uv.0, uv.1) - direction).length() < 1e-7, "{direction}");
        }
        assert_eq!(map.uv(Vec3::Y).1, 0.0);
        assert_eq!(map.uv(Vec3::NEG_Y).1, 1.0);
        // Up, ahead and a little to the right: right of the centre of the upper row.
        assert_eq!(map.radiance(Vec3::new(0.1, 0.7, -0.7).normalize()), Rgb::new(2.0, 0.0, 1.0));
        assert_eq!(map.radiance(Vec3::new(-0.1, -0.7, -0.7).normalize()), Rgb::new(1.0, 1.0, 1.0));
    }

    #[test]
    fn a_rotation_turns_the_map_with_it() {
        for turn in turns() {
            let (plain, turned) = (numbered(7, 5, Quat::IDENTITY), numbered(7, 5, turn));
            for step in 0..1000 {
                let direction = plain.direction((step as f32 * 0.618).fract(), (step as f32 + 0.5) / 1000.0);
                let (expected, found) = (plain.uv(direction), turned.uv(turn * direction));
                let around = (expected.0 - found.0).abs();
                assert!(around.min(1.0 - around) < 1e-4 && (expected.1 - found.1).abs() < 1e-6);
            }
        }
    }

    /// Half a texel off in either direction, and one texel off at a pole or the seam, would be another texel.
    #[test]
    fn centres_and_corners_of_texels_have_their_radiance_up_to_the_poles_and_the_seam() {
        for (width, height) in [(1, 1), (1, 7), (7, 1), (3, 5), (64, 32), (1000, 501)] {
            for turn in turns() {
                let map = numbered(width, height, turn);
                for row in 0..height {
                    for column in 0..width {
                        for inside in [0.002, 0.5, 0.998] {
                            let u = (column as f32 + inside) / width as f32;
                            let v = (row as f32 + inside) / height as f32;
                            let found = map.radiance(map.direction(u, v));
                            // Next to a pole, columns are as narrow as the rounding of a direction.
                            let narrow = (std::f32::consts::PI * v).sin() * inside.min(1.0 - inside)
                                / (width as f32)
                                < 1e-6;
                            assert_eq!(found.g, row as f32, "row {row} of {height}");
                            assert!(
                                narrow || found.r == column as f32,
                                "column {column} of {width}, row {row} of {height}"
                            );
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn coordinates_stay_within_the_map_for_every_direction() {
        let map = numbered(1, 1, Quat::IDENTITY);
        let tiny = [0.0, -0.0, f32::MIN_POSITIVE, -f32::MIN_POSITIVE, 1e-8, -1e-8, 1e-20, -1e-20];
        for a in tiny {
            for b in tiny {
                for one in [1.0, -1.0] {
                    for direction in [Vec3::new(a, b, one), Vec3::new(a, one, b), Vec3::new(one, a, b)] {
                        let (u, v) = map.uv(direction);
                        assert!((0.0..1.0).contains(&u) && (0.0..=1.0).contains(&v), "{direction}: {u}, {v}");
                        assert_eq!(map.uv(direction + Vec3::ZERO), (u, v), "signed zeros make no difference");
                        assert_eq!(map.radiance(direction), Rgb::new(0.0, 0.0, 1.0));
                    }
                }
            }
        }
        // Up to the greatest width, the last u below 1 is in the last column.
        for width in 1..=1 << 15 {
            assert_eq!((BELOW_ONE * width as f32) as usize, width - 1);
        }
    }

    #[test]
    fn directions_have_unit_length_and_their_own_coordinates() {
        let map = numbered(1, 1, turns()[2]);
        for step in 0..100_000 {
            let (u, v) = ((step as f32 * 0.618_034).fract(), (step as f32 + 0.5) / 100_000.0);
            let direction = map.direction(u, v);
            assert!((direction.length() - 1.0).abs() < 3e-7);
            let (again_u, again_v) = map.uv(direction);
            let around = (again_u - u).abs();
            let sin = (std::f32::consts::PI * v).sin();
            assert!(
                around.min(1.0 - around) * sin < 1e-7 && (again_v - v).abs() < 2e-7,
                "{u} {v}: {again_u} {again_v}"
            );
        }
    }
}
