//! Rays.

use crate::math::Vec3;

/// A ray: all points `origin + t · direction` with t > 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// The origin, in world space.
    pub origin: Vec3,
    /// The direction: a unit vector, so that t is a distance in scene units.
    pub direction: Vec3,
    /// Index of the triangle that the ray cannot hit: the one it starts on, if any.
    pub(crate) exclude: Option<u32>,
}

impl Ray {
    /// A ray from a point in a unit direction.
    ///
    /// For a ray that starts on a surface, use [`Hit::spawn`](crate::scene::Hit::spawn), which prevents it from hitting that
    /// surface again.
    #[inline]
    pub fn new(origin: Vec3, direction: Vec3) -> Self {
        Self { origin, direction, exclude: None }
    }
}
