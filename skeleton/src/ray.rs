//! Rays.

use crate::math::Vec3;

/// A half-line: all points `origin + t · direction` with t > 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it starts, in world space.
    pub origin: Vec3,
    /// Where it goes; a unit vector, so that t is a distance in scene units.
    pub direction: Vec3,
    /// The triangle that it leaves and does not hit, if it was spawned, in whatever direction it is turned later.
    pub(crate) exclude: Option<u32>,
}

impl Ray {
    /// A ray from a point into a (unit) direction.
    ///
    /// To leave a surface use [`Hit::spawn`](crate::scene::Hit::spawn), which takes care that the ray does not hit
    /// that surface again.
    #[inline]
    pub fn new(origin: Vec3, direction: Vec3) -> Self {
        Self { origin, direction, exclude: None }
    }
}
