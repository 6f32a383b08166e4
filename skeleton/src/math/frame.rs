//! Local coordinate frames.

use glam::Vec3;

/// A right-handed orthonormal basis whose third axis is a given unit vector.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    tangent: Vec3,
    bitangent: Vec3,
    axis: Vec3,
}

impl Frame {
    /// A frame with the unit vector `axis` as its third axis. The other two are arbitrary but deterministic.
    ///
    /// Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017.
    #[inline]
    pub fn around(axis: Vec3) -> Self {
        let sign = 1f32.copysign(axis.z);
        let a = -1.0 / (sign + axis.z);
        let b = axis.x * axis.y * a;
        Self {
            tangent: Vec3::new(1.0 + sign * axis.x * axis.x * a, sign * b, -sign * axis.x),
            bitangent: Vec3::new(b, sign + axis.y * axis.y * a, -axis.y),
            axis,
        }
    }

    /// Transforms a vector from local coordinates, where the axis is (0, 0, 1), to world space.
    #[inline]
    pub fn to_world(self, local: Vec3) -> Vec3 {
        local.x * self.tangent + local.y * self.bitangent + local.z * self.axis
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_are_orthonormal_and_right_handed_for_every_direction() {
        for i in 0..10_000 {
            // A spiral over the sphere, poles included.
            let z = 1.0 - 2.0 * i as f32 / 9_999.0;
            let phi = i as f32 * 2.399_963;
            let r = (1.0 - z * z).max(0.0).sqrt();
            let axis = Vec3::new(r * phi.cos(), r * phi.sin(), z).normalize();
            let frame = Frame::around(axis);
            let (t, b) = (frame.to_world(Vec3::X), frame.to_world(Vec3::Y));
            assert!(t.dot(b).abs() < 1e-6 && t.dot(axis).abs() < 1e-6 && b.dot(axis).abs() < 1e-6);
            assert!((t.cross(b) - axis).length() < 1e-6);
            assert!((frame.to_world(Vec3::Z) - axis).length() < 1e-6);
        }
    }
}
