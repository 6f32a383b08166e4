//! Close calls, settled in f64.
//!
//! A path that leaves a surface starts a few roundings from it, and a shadow ray ends on the light that it asks
//! about. Whether such a point lies on this or on that side of a triangle is beyond f32. In f64 the differences
//! of f32 coordinates and the products of two of them are exact unless their magnitudes are far apart, so the
//! signs below are those of the true values.

use glam::{DVec3, Vec3};

/// What the tests below need of a triangle besides a corner.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    /// See [`normal`].
    normal: DVec3,
    /// The greatest coordinates of corners by magnitude, along the normal: Σ|nᵢ||vᵢ|.
    reach: f64,
}

impl Plane {
    /// That of no triangle.
    pub(super) const NONE: Self = Self { normal: DVec3::ZERO, reach: 0.0 };

    /// The plane of a triangle.
    pub(super) fn new(triangle: &[Vec3; 3]) -> Self {
        let normal = normal(triangle);
        let [a, b, c] = triangle.map(Vec3::abs);
        Self { normal, reach: normal.abs().dot(a.max(b).max(c).as_dvec3()) }
    }
}

/// Distance at which the plane of a triangle with this `corner` is met, in lengths of the direction; `None` if it is not ahead.
///
/// The origin may be so near to the plane that even f64 cannot tell, as after cancellation in a point next to
/// (0, 0, 0). Then it is taken to lie on the plane, which is not ahead. The distance is positive even where it is
/// too small for f32.
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

/// True if the two points lie strictly on opposite sides of the plane of a triangle with this `corner`, `target` by more than the
/// rounding of its coordinates explains.
///
/// `target` is taken as a point that was rounded to f32, from a surface whose vertices were: each of its
/// coordinates p is off by up to u·|p|, u = 2⁻²⁴, and each coordinate of the vertices that gave it and of those
/// of this triangle by u·|v|. With normal n, that moves its distance from the plane by up to
/// u·Σ|nᵢ|(|pᵢ| + 2|vᵢ|) / |n|. So what `target` lies on, and what continues that flatly, does not separate.
#[inline(always)]
pub(super) fn separates(plane: &Plane, corner: Vec3, origin: Vec3, target: Vec3) -> bool {
    let normal = plane.normal;
    let from_origin = normal.dot(origin.as_dvec3() - corner.as_dvec3());
    let from_target = normal.dot(target.as_dvec3() - corner.as_dvec3());
    let rounding =
        f64::from(f32::EPSILON / 2.0) * (normal.abs().dot(target.abs().as_dvec3()) + 2.0 * plane.reach);
    (from_origin < 0.0 && from_target > rounding) || (from_origin > 0.0 && from_target < -rounding)
}

/// (v₁ − v₀) × (v₂ − v₀): not a unit vector, but twice the area long.
#[inline]
pub(super) fn normal(triangle: &[Vec3; 3]) -> DVec3 {
    let corner = triangle[0].as_dvec3();
    (triangle[1].as_dvec3() - corner).cross(triangle[2].as_dvec3() - corner)
}
