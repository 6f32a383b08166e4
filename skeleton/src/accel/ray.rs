//! What the tests of boxes and triangles need of a ray, worked out once for each ray.

use glam::Vec3;

/// Rounding of one operation: half an ulp, relative.
const UNIT_ROUNDOFF: f32 = f32::EPSILON / 2.0;

/// A ray made ready for traversal.
#[derive(Clone, Copy)]
pub(super) struct PreparedRay {
    /// Where it starts.
    pub(super) origin: [f32; 3],
    /// Where it goes; any length.
    pub(super) direction: [f32; 3],
    /// For each axis, whether the ray runs against it: which of a box's two planes it meets first.
    pub(super) reversed: [bool; 3],
    /// The origin moved so that the nearer planes of a box come too early, never too late.
    pub(super) near_origin: [f32; 3],
    /// The origin moved so that the farther planes of a box come too late, never too early.
    pub(super) far_origin: [f32; 3],
    /// Reciprocal direction, made smaller by more than its rounding and that of the products with it.
    pub(super) near_inverse: [f32; 3],
    /// Reciprocal direction, made greater likewise.
    pub(super) far_inverse: [f32; 3],
    /// The axes in the order x, y, z of the sheared space; z is that in which the direction is longest.
    pub(super) axes: [usize; 3],
    /// How much x and y change with z along the ray.
    pub(super) shear: [f32; 2],
}

impl PreparedRay {
    /// Makes a ray ready, or gives `None` if it has no direction or is not finite.
    ///
    /// `bounds` are the least and the greatest corner of a box around the geometry.
    ///
    /// The slab test of Ize ("Robust BVH Ray Traversal", JCGT 2013) makes a box only as much larger as its own
    /// rounding asks for. The triangle test rounds too: seen from the ray, it moves vertices by a few roundings
    /// of their distance from the origin along an axis. A box must be hit whenever a triangle in it is, so the
    /// box grows by as much, as in the appendix of Woop et al. (JCGT 2013).
    #[inline(always)]
    pub(super) fn new(origin: Vec3, direction: Vec3, bounds: [Vec3; 2]) -> Option<Self> {
        let length = direction.abs().max_element();
        let farthest = (bounds[0] - origin).abs().max((bounds[1] - origin).abs()).max_element();
        // Written so that what is not a number fails.
        if !(length > 0.0 && length <= f32::MAX && farthest <= f32::MAX)
            || direction.is_nan()
            || origin.is_nan()
        {
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
        let origin = origin.to_array();
        let direction = direction.to_array();

        let padding = 8.0 * UNIT_ROUNDOFF * farthest;
        let mut ray = Self {
            origin,
            direction,
            reversed: [false; 3],
            near_origin: origin,
            far_origin: origin,
            near_inverse: [0.0; 3],
            far_inverse: [0.0; 3],
            axes,
            shear: [direction[axes[0]] / direction[z], direction[axes[1]] / direction[z]],
        };
        for axis in 0..3 {
            // A component of 0 gives an infinity with its sign. The distance to a plane is then infinite too,
            // with the right sign, or not a number for a plane through the origin, which constrains nothing.
            let inverse = 1.0 / direction[axis];
            let forward = padding.copysign(inverse);
            ray.reversed[axis] = inverse < 0.0;
            ray.near_origin[axis] = origin[axis] + forward;
            ray.far_origin[axis] = origin[axis] - forward;
            ray.near_inverse[axis] = inverse * (1.0 - 4.0 * UNIT_ROUNDOFF);
            ray.far_inverse[axis] = inverse * (1.0 + 4.0 * UNIT_ROUNDOFF);
        }
        Some(ray)
    }
}
