//! Rays, prepared for triangle and box tests.

use glam::Vec3;

/// Relative rounding error of one operation: half an ulp.
const UNIT_ROUNDOFF: f32 = f32::EPSILON / 2.0;

/// A ray prepared for triangle tests.
#[derive(Clone, Copy)]
pub(super) struct PreparedRay {
    /// The origin.
    pub(super) origin: [f32; 3],
    /// The direction, of any length.
    pub(super) direction: [f32; 3],
    /// The axes that become x, y, z of the sheared space; the direction is largest along z.
    pub(super) axes: [usize; 3],
    /// The change of x and y with z along the ray.
    pub(super) shear: [f32; 2],
    /// The triangle that is not tested.
    pub(super) exclude: u32,
}

impl PreparedRay {
    /// Prepares a ray; `None` if its direction is zero or a coordinate is not finite.
    #[inline(always)]
    pub(super) fn new(origin: Vec3, direction: Vec3, exclude: u32) -> Option<Self> {
        let length = direction.abs().max_element();
        if length == 0.0 || !direction.is_finite() || !origin.is_finite() {
            return None;
        }
        let z = if direction.x.abs() == length {
            0
        } else if direction.y.abs() == length {
            1
        } else {
            2
        };
        let axes = [(z + 1) % 3, (z + 2) % 3, z];
        let direction = direction.to_array();
        let shear = [direction[axes[0]] / direction[z], direction[axes[1]] / direction[z]];
        Some(Self { origin: origin.to_array(), direction, axes, shear, exclude })
    }
}

/// A ray prepared for box tests.
#[derive(Clone, Copy)]
pub(super) struct Slabs {
    /// For each axis, whether the direction is negative: this determines which plane of a box comes first.
    pub(super) reversed: [bool; 3],
    /// The origin, shifted such that near planes are never too far.
    pub(super) near_origin: [f32; 3],
    /// The origin, shifted such that far planes are never too near.
    pub(super) far_origin: [f32; 3],
    /// Reciprocal direction, decreased by more than its rounding error and that of products with it.
    pub(super) near_inverse: [f32; 3],
    /// Reciprocal direction, increased likewise.
    pub(super) far_inverse: [f32; 3],
}

impl Slabs {
    /// Prepares a ray; `bounds` are the minimum and maximum corner of the bounding box.
    ///
    /// The slab test of Ize ("Robust BVH Ray Traversal", JCGT 2013) enlarges a box by its own rounding error only. The
    /// triangle test has rounding errors, too: relative to the ray, it moves vertices by a few ulps of their distance from the
    /// origin along an axis. A box must be hit whenever a triangle in it is, so boxes are enlarged by that amount, as in the
    /// appendix of Woop et al. (JCGT 2013).
    #[inline(always)]
    pub(super) fn new(ray: &PreparedRay, bounds: [Vec3; 2]) -> Self {
        let origin = Vec3::from(ray.origin);
        let farthest = (bounds[0] - origin).abs().max((bounds[1] - origin).abs()).max_element();
        let padding = 8.0 * UNIT_ROUNDOFF * farthest;
        let mut slabs = Self {
            reversed: [false; 3],
            near_origin: ray.origin,
            far_origin: ray.origin,
            near_inverse: [0.0; 3],
            far_inverse: [0.0; 3],
        };
        for axis in 0..3 {
            // A component of 0 gives an infinity of the same sign. The distance to a plane is then infinite with the
            // correct sign, or NaN for a plane through the origin, which is no constraint.
            let inverse = 1.0 / ray.direction[axis];
            let forward = padding.copysign(inverse);
            slabs.reversed[axis] = inverse < 0.0;
            slabs.near_origin[axis] = ray.origin[axis] + forward;
            slabs.far_origin[axis] = ray.origin[axis] - forward;
            slabs.near_inverse[axis] = inverse * (1.0 - 4.0 * UNIT_ROUNDOFF);
            slabs.far_inverse[axis] = inverse * (1.0 + 4.0 * UNIT_ROUNDOFF);
        }
        slabs
    }
}
