//! What the tests of triangles and boxes need of a ray, worked out once for each ray.

use glam::Vec3;

/// Rounding of one operation: half an ulp, relative.
const UNIT_ROUNDOFF: f32 = f32::EPSILON / 2.0;

/// A ray made ready for tests of triangles.
#[derive(Clone, Copy)]
pub(super) struct PreparedRay {
    /// Where it starts.
    pub(super) origin: [f32; 3],
    /// Where it goes; any length.
    pub(super) direction: [f32; 3],
    /// The axes in the order x, y, z of the sheared space; z is that in which the direction is longest.
    pub(super) axes: [usize; 3],
    /// How much x and y change with z along the ray.
    pub(super) shear: [f32; 2],
    /// The triangle that it does not hit.
    pub(super) exclude: u32,
}

impl PreparedRay {
    /// Makes a ray ready, or gives `None` if it has no direction or is not finite.
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

/// A ray made ready for tests of boxes.
#[derive(Clone, Copy)]
pub(super) struct Slabs {
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
}

impl Slabs {
    /// Makes a ray ready; `bounds` are the minimum and maximum corner of the bounding box.
    ///
    /// The slab test of Ize ("Robust BVH Ray Traversal", JCGT 2013) makes a box only as much larger as its own
    /// rounding asks for. The triangle test rounds too: seen from the ray, it moves vertices by a few roundings
    /// of their distance from the origin along an axis. A box must be hit whenever a triangle in it is, so the
    /// box grows by as much, as in the appendix of Woop et al. (JCGT 2013).
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
            // A component of 0 gives an infinity with its sign. The distance to a plane is then infinite too,
            // with the right sign, or not a number for a plane through the origin, which constrains nothing.
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
