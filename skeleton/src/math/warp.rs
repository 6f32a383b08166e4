//! Sampling routines: from uniform random numbers in [0, 1) to points and directions, with their densities.
//!
//! Directions are unit vectors in local coordinates around (0, 0, 1); their densities are per solid angle.

use std::f32::consts::{FRAC_1_PI, FRAC_PI_4};

use glam::{Vec2, Vec3};

use super::trigonometry::sin_cos_eighth_turn;

/// A uniformly distributed point in the unit disk.
///
/// The concentric map of Shirley and Chiu, "A Low Distortion Map Between Disk and Square", JGT 2(3), 1997.
#[inline]
pub fn disk((u, v): (f32, f32)) -> Vec2 {
    let (a, b) = (2.0 * u - 1.0, 2.0 * v - 1.0);
    if a == 0.0 && b == 0.0 {
        return Vec2::ZERO;
    }
    if a.abs() > b.abs() {
        let (sin, cos) = sin_cos_eighth_turn(FRAC_PI_4 * (b / a));
        a * Vec2::new(cos, sin)
    } else {
        let (sin, cos) = sin_cos_eighth_turn(FRAC_PI_4 * (a / b));
        b * Vec2::new(sin, cos)
    }
}

/// A direction in the upper hemisphere with a density proportional to its cosine (Malley's method: a point in the unit
/// disk, projected up to the hemisphere).
#[inline]
pub fn cosine_hemisphere(u: (f32, f32)) -> Vec3 {
    let point = disk(u);
    // At the rim z may round to zero; a positive minimum keeps the direction above the horizon.
    let z = (1.0 - point.length_squared()).max(1e-12).sqrt();
    point.extend(z)
}

/// The density of [`cosine_hemisphere`]: cos θ / π, zero at and below the horizon.
#[inline]
pub fn cosine_hemisphere_pdf(cos: f32) -> f32 {
    cos.max(0.0) * FRAC_1_PI
}

/// A direction around the axis with a density proportional to cosⁿ α, for an exponent n ≥ 0.
///
/// Lafortune and Willems, "Using the Modified Phong Reflectance Model for Physically Based Rendering", report
/// CW 197, K.U. Leuven, 1994: cos α = u^{1/(n+1)}, φ = 2πv.
///
/// u and φ are the squared radius and the angle of a point in the unit disk. In narrow lobes cos α is within a few ulps
/// of 1, so 1 − cos α = −expm1(ln u / (n + 1)) is computed instead.
#[inline]
pub fn cosine_power(u: (f32, f32), exponent: f32) -> Vec3 {
    let point = disk(u);
    let squared_radius = point.length_squared().min(1.0);
    if squared_radius == 0.0 {
        return Vec3::Z; // the centre, where the angle is undefined
    }
    let one_minus_cos = -(squared_radius.ln() / (exponent + 1.0)).exp_m1();
    let sin = (one_minus_cos * (2.0 - one_minus_cos)).max(0.0).sqrt();
    (point * (sin / squared_radius.sqrt())).extend(1.0 - one_minus_cos)
}

/// The density of [`cosine_power`]: (n + 1) / 2π · cosⁿ α.
#[inline]
pub fn cosine_power_pdf(power_of_cosine: f32, exponent: f32) -> f32 {
    (exponent + 1.0) * (0.5 * FRAC_1_PI) * power_of_cosine
}

/// cosⁿ α for the angle α between two unit vectors, zero for α ≥ π/2.
///
/// Computed as exp(n·ln(1 − |a − b|²/2)): for almost equal vectors the difference is exact, the dot product is not. With
/// n = 10⁶ one rounding of the dot product would change the result by 6 %.
#[inline]
pub fn power_of_cosine(a: Vec3, b: Vec3, exponent: f32) -> f32 {
    let one_minus_cos = 0.5 * (a - b).length_squared();
    if one_minus_cos >= 1.0 {
        return 0.0;
    }
    (exponent * (-one_minus_cos).ln_1p()).exp()
}

/// Barycentric weights (of the second and third vertex) of a uniformly distributed point in a triangle.
///
/// The map of Heitz, "A Low-Distortion Map Between Triangle and
/// Square", 2019. Its density is 1 / area.
#[inline]
pub fn triangle((u, v): (f32, f32)) -> [f32; 2] {
    if v > u {
        let half = 0.5 * u;
        [half, v - half]
    } else {
        let half = 0.5 * v;
        [u - half, half]
    }
}
