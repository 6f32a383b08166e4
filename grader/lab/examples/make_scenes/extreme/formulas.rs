//! Closed forms of direct light.

use std::f64::consts::PI;

use super::FLOOR;

/// What the floor shows where the irradiance is E: ρE/π.
pub(super) fn floor_shows(irradiance: f64) -> f64 {
    FLOOR * irradiance / PI
}

/// The irradiance below the middle of a parallel square: four rectangles that each have a corner overhead.
///
/// E = (L/2) (X/√(1+X²) · atan(Y/√(1+X²)) + Y/√(1+Y²) · atan(X/√(1+Y²))) for each, with X and Y the sides divided by the
/// height (Howell, "A Catalog of Radiation Heat Transfer Configuration Factors", B-4).
pub(super) fn below_square(height: f64, side: f64, radiance: f64) -> f64 {
    let x = 0.5 * side / height;
    let root = (1.0 + x * x).sqrt();
    4.0 * radiance / 2.0 * 2.0 * (x / root * (x / root).atan())
}

/// The irradiance of the floor at the origin under a point of intensity I.
pub(super) fn below_point(intensity: f64, position: glam::DVec3) -> f64 {
    intensity * position.y / position.length().powi(3)
}
