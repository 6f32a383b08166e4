//! Maps from uniform random numbers to points and directions, each with its density.
//!
//! All take numbers in [0, 1). Directions are unit vectors in local coordinates around (0, 0, 1); their densities
//! are per solid angle.

use std::f32::consts::{FRAC_1_PI, FRAC_PI_4};

use glam::{Vec2, Vec3};

use super::trigonometry::sin_cos_eighth_turn;

/// A uniformly distributed point of the unit disk.
///
/// The concentric map of Shirley and Chiu, "A Low Distortion Map Between Disk and Square", JGT 2(3), 1997: radius
/// and angle come from the two triangles that the square's diagonals cut on either side.
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

/// A direction of the upper hemisphere, with a density proportional to its cosine: a point of the disk, lifted
/// (Malley's method).
#[inline]
pub fn cosine_hemisphere(u: (f32, f32)) -> Vec3 {
    let point = disk(u);
    // On the rim rounding can leave nothing for z; the smallest height keeps the direction above the horizon.
    let z = (1.0 - point.length_squared()).max(1e-12).sqrt();
    point.extend(z)
}

/// The density of [`cosine_hemisphere`]: cos θ / π, and zero from the horizon down.
#[inline]
pub fn cosine_hemisphere_pdf(cos: f32) -> f32 {
    cos.max(0.0) * FRAC_1_PI
}

/// A direction around the axis with a density proportional to cosⁿ α, for an exponent n ≥ 0.
///
/// Lafortune and Willems, "Using the Modified Phong Reflectance Model for Physically Based Rendering", report
/// CW 197, K.U. Leuven, 1994: cos α = u^{1/(n+1)}, φ = 2πv.
///
/// Both come from a point of the disk: its squared radius is uniform and serves as u, its angle is φ. In narrow
/// lobes cos α is within a few roundings of 1, so that it is 1 − cos α = −expm1(ln u / (n + 1)) that is computed.
#[inline]
pub fn cosine_power(u: (f32, f32), exponent: f32) -> Vec3 {
    let point = disk(u);
    let squared_radius = point.length_squared().min(1.0);
    if squared_radius == 0.0 {
        return Vec3::Z; // the one point that has no angle
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

/// cosⁿ α between two unit vectors, zero if they are more than a right angle apart.
///
/// Computed as exp(n·ln(1 − |a − b|²/2)): their difference is exact where they almost agree, which their product
/// is not. With n = 10⁶ a rounding of the product would change the result by 6 %.
#[inline]
pub fn power_of_cosine(a: Vec3, b: Vec3, exponent: f32) -> f32 {
    let one_minus_cos = 0.5 * (a - b).length_squared();
    if one_minus_cos >= 1.0 {
        return 0.0;
    }
    (exponent * (-one_minus_cos).ln_1p()).exp()
}

/// Barycentric weights (of the second and third corner) of a uniformly distributed point of a triangle.
///
/// The unit square folded along its diagonal by the map of Heitz, "A Low-Distortion Map Between Triangle and
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
