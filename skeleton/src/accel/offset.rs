//! Points on triangles, and where rays may start that leave them.

use glam::Vec3;

/// The point with the given weights of corners 1 and 2, each coordinate rounded to f32 once.
#[inline]
pub fn point_on(triangle: &[Vec3; 3], barycentrics: [f32; 2]) -> Vec3 {
    let [a, b, c] = triangle.map(Vec3::as_dvec3);
    let [v, w] = barycentrics.map(f64::from);
    (a + (b - a) * v + (c - a) * w).as_vec3()
}

/// Moves a point of a surface off it, to the side that `direction` goes to.
///
/// `point` is a point of the plane with normal n (unit length, either side) whose coordinates were rounded to f32
/// once, as those of [`point_on`]: coordinate i is off by up to uᵢ/2, uᵢ its ulp, and so the point is within
/// ½Σ|nᵢ|uᵢ of the plane. It is moved by δ along n and rounded again. A coordinate that passes a power of two has
/// an ulp of 2uᵢ afterwards, so that takes back up to Σ|nᵢ|uᵢ. Therefore δ > 1.5·Σ|nᵢ|uᵢ keeps it strictly on its
/// side, and a thousandth more is for the rounding of n.
///
/// A coordinate near 0 has a tiny ulp but is no more exact than the f64 sum that it comes from; so a 2⁻³⁰th
/// of the greatest coordinate is the least that counts as an ulp, and 2⁻¹⁰⁰ where all are 0.
///
/// All in f32: the products with n are off by 2⁻²⁴ of δ, which the thousandth covers too.
#[inline]
pub fn offset_origin(point: Vec3, geometric_normal: Vec3, direction: Vec3) -> Vec3 {
    const TINY: f32 = 1.0 / (1u128 << 100) as f32;
    let floor = point.abs().max_element() * (1.0 / (1 << 30) as f32) + TINY;
    let ulps = Vec3::from_array(point.to_array().map(ulp)).max(Vec3::splat(floor));
    let distance = 1.5015 * geometric_normal.abs().dot(ulps);
    point + geometric_normal * distance.copysign(geometric_normal.dot(direction))
}

/// The distance from a number to the next greater in magnitude; 0 for numbers too small to have one in f32.
#[inline]
fn ulp(x: f32) -> f32 {
    // All bits but the exponent's cleared: the greatest power of two that is not above |x|.
    f32::from_bits(x.to_bits() & 0x7f80_0000) * f32::EPSILON
}
