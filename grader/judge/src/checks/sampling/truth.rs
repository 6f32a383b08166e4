//! What the sheet asks for: the probability of each texel, and points at which to integrate a density.

use std::f64::consts::{PI, TAU};

use arty::environment::Environment;
use arty::math::Vec3;
use arty::scene::EnvironmentDescription;

/// Maps of at most so many texels are integrated in detail.
const MAX_DETAILED: usize = 4096;

/// Number of parts of a texel in each direction, where it is integrated in detail.
pub(super) const PARTS: usize = 4;

/// Gauss-Legendre quadrature with three points in [0, 1]: exact for a density per solid angle that is uniform in the polar
/// angle, and to 1e-6 for one that is uniform in the solid angle.
const GAUSS: [(f64, f64); 3] =
    [(0.112_701_665_379_258_3, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];

/// A map with its probabilities.
pub(super) struct Truth {
    pub(super) environment: Environment,
    pub(super) width: usize,
    pub(super) height: usize,
    /// Probability of each texel; all 0 for a black map.
    pub(super) probabilities: Vec<f64>,
    /// Relative variance of the luminance of uniform directions; 0 for a black map.
    pub(super) variance_of_uniform: f64,
}

/// A point of a quadrature.
pub(super) struct Point {
    pub(super) direction: Vec3,
    /// Solid angle that it stands for.
    pub(super) solid_angle: f64,
    /// The place that it stands for.
    pub(super) place: Place,
}

/// A place in a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Place {
    /// Index of the texel, row by row.
    pub(super) texel: usize,
    /// The part of the texel: of [`PARTS`] columns, then rows.
    pub(super) part: usize,
}

impl Place {
    /// Index among the parts of all texels.
    pub(super) fn index(self) -> usize {
        self.texel * PARTS * PARTS + self.part
    }
}

impl Truth {
    pub(super) fn new(map: &EnvironmentDescription) -> Self {
        let (width, height) = (map.width as usize, map.height as usize);
        let luminance = |index: usize| f64::from(map.texels[index].luminance());
        let solid_angle = |index: usize| {
            let at = |row: usize| PI * row as f64 / height as f64;
            let (top, bottom) = (at(index / width), at(index / width + 1));
            // cos top − cos bottom
            2.0 * (0.5 * (top + bottom)).sin() * (0.5 * (bottom - top)).sin() * TAU / width as f64
        };
        let texels = 0..width * height;
        let total: f64 = texels.clone().map(|index| luminance(index) * solid_angle(index)).sum();
        let squares: f64 = texels.clone().map(|index| luminance(index).powi(2) * solid_angle(index)).sum();
        let probability =
            |index| if total > 0.0 { luminance(index) * solid_angle(index) / total } else { 0.0 };
        Self {
            environment: Environment::new(width, height, map.texels.clone(), map.rotation),
            width,
            height,
            probabilities: texels.map(probability).collect(),
            variance_of_uniform: if total > 0.0 { squares * 2.0 * TAU / total.powi(2) - 1.0 } else { 0.0 },
        }
    }

    pub(super) fn is_black(&self) -> bool {
        self.probabilities.iter().all(|&probability| probability == 0.0)
    }

    /// True if texels are integrated in detail, part by part.
    pub(super) fn is_detailed(&self) -> bool {
        self.probabilities.len() <= MAX_DETAILED
    }

    /// The place of a direction.
    pub(super) fn place_of(&self, direction: Vec3) -> Place {
        let (u, v) = self.environment.uv(direction);
        let within = |coordinate: f32, count: usize| {
            let parts = ((f64::from(coordinate) * (count * PARTS) as f64) as usize).min(count * PARTS - 1);
            (parts / PARTS, parts % PARTS)
        };
        let ((column, part_column), (row, part_row)) = (within(u, self.width), within(v, self.height));
        Place { texel: row * self.width + column, part: part_row * PARTS + part_column }
    }

    /// The points at which a density is integrated.
    pub(super) fn points(&self) -> Vec<Point> {
        let mut points = Vec::new();
        let detailed = self.is_detailed();
        let parts = if detailed { PARTS } else { 1 };
        for texel in 0..self.probabilities.len() {
            let (column, row) = (texel % self.width, texel / self.width);
            for part in 0..parts * parts {
                let (part_column, part_row) = (part % parts, part / parts);
                let u = (column as f64 + (part_column as f64 + 0.5) / parts as f64) / self.width as f64;
                let azimuth = TAU / (self.width * parts) as f64;
                let polar = PI / (self.height * parts) as f64;
                let gauss: &[(f64, f64)] = if detailed { &GAUSS } else { &[(0.5, 1.0)] };
                for (at, weight) in gauss {
                    let v = (row as f64 + (part_row as f64 + at) / parts as f64) / self.height as f64;
                    points.push(Point {
                        direction: self.environment.direction(u as f32, v as f32),
                        solid_angle: weight * (PI * v).sin() * polar * azimuth,
                        place: Place { texel, part },
                    });
                }
            }
        }
        points
    }

    /// Directions at the edge of what is defined: the poles, the seam, and borders of texels.
    pub(super) fn edges(&self) -> Vec<Vec3> {
        let mut edges = Vec::new();
        for step in 0..=8 {
            edges.extend(
                (0..=8).map(|other| self.environment.direction(step as f32 / 8.0, other as f32 / 8.0)),
            );
        }
        for column in [0, 1, self.width / 2, self.width] {
            for row in [0, 1, self.height / 2, self.height] {
                let (u, v) = (column as f32 / self.width as f32, row as f32 / self.height as f32);
                edges.push(self.environment.direction(u, v));
            }
        }
        edges.extend([Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z, Vec3::X, Vec3::NEG_X]);
        edges
    }
}
