//! Closed forms of irradiance for radiance 1.

use std::f64::consts::PI;

use glam::DVec3;

/// Lambert's formula: the irradiance at `point` on a surface with the unit normal `normal`, from a polygon above
/// its horizon: E = ½ |Σ Θᵢ n·Γᵢ|, where Θᵢ is the angle subtended by edge i and Γᵢ the unit normal of the plane through
/// the edge and the point.
pub(crate) fn polygon(corners: &[DVec3], point: DVec3, normal: DVec3) -> f64 {
    let edge = |i: usize| {
        let (a, b) = (corners[i] - point, corners[(i + 1) % corners.len()] - point);
        let cross = a.cross(b);
        cross.length().atan2(a.dot(b)) * cross.normalize().dot(normal)
    };
    0.5 * (0..corners.len()).map(edge).sum::<f64>().abs()
}

/// A rectangle of `a × b` parallel to the surface at height `h`, with a corner directly above the point.
pub(crate) fn corner_rectangle(a: f64, b: f64, h: f64) -> f64 {
    let (x, y) = (a / h, b / h);
    let (p, q) = ((1.0 + x * x).sqrt(), (1.0 + y * y).sqrt());
    0.5 * (x / p * (y / p).atan() + y / q * (x / q).atan())
}

/// A disk of radius `r` parallel to the surface at height `h`, with a horizontal offset `a`.
pub(crate) fn disk(r: f64, h: f64, a: f64) -> f64 {
    let (h2, a2, r2) = (h * h, a * a, r * r);
    let root = ((h2 + a2 + r2).powi(2) - 4.0 * a2 * r2).sqrt();
    0.5 * PI * (1.0 - (h2 + a2 - r2) / root)
}

/// A sphere of radius `r` at the distance `d`, with a cosine of at least r / d.
pub(crate) fn sphere(r: f64, d: f64, cos: f64) -> f64 {
    PI * (r / d).powi(2) * cos
}
