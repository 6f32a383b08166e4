//! Predicates, decided in f64.
//!
//! A ray from a surface starts a few ulps off it, and a shadow ray ends on a light. On which side of a triangle such a point
//! is cannot be decided in f32. In f64, differences of f32 coordinates and products of two of them are exact unless their
//! magnitudes are very different, so the signs computed below are correct.

use glam::{DVec3, Vec3};

/// The plane of a triangle, as the predicates below need it in addition to a vertex.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    /// See [`normal`].
    normal: DVec3,
    /// Σ|nᵢ||vᵢ|, with the largest coordinates of the vertices by magnitude.
    reach: f64,
}

impl Plane {
    /// The plane of an unused lane.
    pub(super) const NONE: Self = Self { normal: DVec3::ZERO, reach: 0.0 };

    /// The plane of a triangle.
    pub(super) fn new(triangle: &[Vec3; 3]) -> Self {
        let normal = normal(triangle);
        let [a, b, c] = triangle.map(Vec3::abs);
        Self { normal, reach: normal.abs().dot(a.max(b).max(c).as_dvec3()) }
    }
}

/// Distance to the plane of a triangle with this `corner`, in multiples of the direction's length; `None` if the plane is not
/// ahead.
///
/// The origin may be so close to the plane that even f64 cannot decide, as after cancellation near (0, 0, 0). Then it counts
/// as on the plane, which is not ahead. The distance is positive even if it is too small for f32.
#[inline(always)]
pub(super) fn distance_ahead(plane: &Plane, corner: Vec3, origin: Vec3, direction: Vec3) -> Option<f32> {
    let normal = plane.normal;
    let height = normal.dot(corner.as_dvec3() - origin.as_dvec3());
    let magnitude = normal.abs().dot((corner.abs() + origin.abs()).as_dvec3());
    if height.abs() <= 8.0 * f64::EPSILON * magnitude {
        return None;
    }
    let t = height / normal.dot(direction.as_dvec3());
    (t > 0.0 && t < f64::from(f32::MAX)).then(|| (t as f32).max(f32::MIN_POSITIVE))
}

/// True if the two points are strictly on opposite sides of the plane of a triangle with this `corner`, `target` by more than
/// the rounding error of its coordinates.
///
/// `target` is a point rounded to f32 on a surface whose vertices were rounded to f32: each of its coordinates p has an error
/// of up to u·|p|, u = 2⁻²⁴, and each coordinate of the vertices of either triangle one of up to u·|v|. With the normal n,
/// the error of its distance from the plane is at most u·Σ|nᵢ|(|pᵢ| + 2|vᵢ|) / |n|. So the surface that contains `target`,
/// and a coplanar one next to it, does not separate the points.
#[inline(always)]
pub(super) fn separates(plane: &Plane, corner: Vec3, origin: Vec3, target: Vec3) -> bool {
    let normal = plane.normal;
    let from_origin = normal.dot(origin.as_dvec3() - corner.as_dvec3());
    let from_target = normal.dot(target.as_dvec3() - corner.as_dvec3());
    let rounding =
        f64::from(f32::EPSILON / 2.0) * (normal.abs().dot(target.abs().as_dvec3()) + 2.0 * plane.reach);
    (from_origin < 0.0 && from_target > rounding) || (from_origin > 0.0 && from_target < -rounding)
}

/// (v₁ − v₀) × (v₂ − v₀), whose length is twice the area.
#[inline]
pub(super) fn normal(triangle: &[Vec3; 3]) -> DVec3 {
    let corner = triangle[0].as_dvec3();
    (triangle[1].as_dvec3() - corner).cross(triangle[2].as_dvec3() - corner)
}
