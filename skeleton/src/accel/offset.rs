//! Points on triangles, and the origins of rays that start there.

use glam::Vec3;

/// The point with the given barycentric weights of vertices 1 and 2, each coordinate rounded to f32 once.
#[inline]
pub fn point_on(triangle: &[Vec3; 3], barycentrics: [f32; 2]) -> Vec3 {
    let [a, b, c] = triangle.map(Vec3::as_dvec3);
    let [v, w] = barycentrics.map(f64::from);
    (a + (b - a) * v + (c - a) * w).as_vec3()
}

/// Offsets a point on a surface to the side that `direction` points to.
///
/// `point` is a point on the plane with the unit normal n (on either side) whose coordinates were rounded to f32 once, as by
/// [`point_on`]: coordinate i has an error of up to uᵢ/2, where uᵢ is its ulp, so the point is within ½Σ|nᵢ|uᵢ of the plane.
/// It is moved by δ along n and rounded again. If a coordinate crosses a power of two, its ulp becomes 2uᵢ, so the second
/// rounding moves the point back by up to Σ|nᵢ|uᵢ. Hence δ > 1.5·Σ|nᵢ|uᵢ keeps it strictly on its side; one thousandth is
/// added for the rounding of n.
///
/// A coordinate near 0 has a tiny ulp, but is no more precise than the f64 sum it was computed from. Therefore ulps are at
/// least 2⁻³⁰ of the largest coordinate, and 2⁻¹⁰⁰ if all are 0.
///
/// Everything is computed in f32: the relative error 2⁻²⁴ of the products with n is covered by the thousandth, too.
#[inline]
pub fn offset_origin(point: Vec3, geometric_normal: Vec3, direction: Vec3) -> Vec3 {
    const TINY: f32 = 1.0 / (1u128 << 100) as f32;
    let floor = point.abs().max_element() * (1.0 / (1 << 30) as f32) + TINY;
    let ulps = Vec3::from_array(point.to_array().map(ulp)).max(Vec3::splat(floor));
    let distance = 1.5015 * geometric_normal.abs().dot(ulps);
    point + geometric_normal * distance.copysign(geometric_normal.dot(direction))
}

/// The ulp of a number; 0 for numbers too small to have one in f32.
#[inline]
fn ulp(x: f32) -> f32 {
    // The exponent alone: the largest power of two not above |x|.
    f32::from_bits(x.to_bits() & 0x7f80_0000) * f32::EPSILON
}
