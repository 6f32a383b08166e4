//! Transforms of meshes, in double precision.

use std::fmt;

use glam::{DAffine3, DMat3, DQuat, DVec3, Quat, Vec3};
use serde::Deserialize;
use serde::de::value::SeqAccessDeserializer;
use serde::de::{Deserializer, Error, SeqAccess, Visitor};

use super::checks::{Number, Vector, mapping};

/// One step of the list `transform`.
#[derive(Clone, Copy, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(untagged))]
#[serde(rename_all = "snake_case")]
pub(super) enum Step {
    /// Scaling by one factor, or by three along the axes.
    Scale(Scale),
    /// Rotation about an axis through the origin, counter-clockwise seen from its tip.
    Rotate(Rotation),
    /// Translation by an offset.
    Translate(Vector),
    /// An affine matrix for column vectors, in row-major order.
    Matrix(Matrix),
}

/// Composes the steps, applied in the given order.
///
/// # Errors
/// If the result is not finite or singular.
pub(super) fn compose(steps: &[Step]) -> Result<DAffine3, String> {
    let whole = steps.iter().fold(DAffine3::IDENTITY, |before, step| step.affine() * before);
    if !whole.is_finite() {
        return Err("the transform exceeds the range of double precision".into());
    }
    if is_singular(whole.matrix3) {
        return Err("the transform is singular: it flattens the mesh".into());
    }
    Ok(whole)
}

impl Step {
    fn affine(self) -> DAffine3 {
        match self {
            Self::Scale(Scale(factors)) => DAffine3::from_scale(factors),
            Self::Rotate(Rotation { axis, radians }) => DAffine3::from_axis_angle(axis, radians),
            Self::Translate(offset) => DAffine3::from_translation(offset.double()),
            Self::Matrix(Matrix(affine)) => affine,
        }
    }
}

/// True if the volume spanned by the columns is zero, up to rounding, relative to that of a box with their lengths.
fn is_singular(matrix: DMat3) -> bool {
    let lengths = matrix.x_axis.length() * matrix.y_axis.length() * matrix.z_axis.length();
    let volume = matrix.determinant().abs();
    // If the product overflows or underflows, the matrix cannot be inverted either.
    !volume.is_normal() || volume <= 1e-12 * lengths
}

/// The payload of `!scale`.
#[derive(Clone, Copy)]
pub(super) struct Scale(DVec3);

impl<'de> Deserialize<'de> for Scale {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ScaleVisitor;
        impl<'de> Visitor<'de> for ScaleVisitor {
            type Value = Scale;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("one finite number or a list of three")
            }
            fn visit_f64<E: Error>(self, value: f64) -> Result<Scale, E> {
                if value.is_finite() {
                    Ok(Scale(DVec3::splat(value)))
                } else {
                    Err(E::invalid_value(serde::de::Unexpected::Float(value), &self))
                }
            }
            fn visit_i64<E: Error>(self, value: i64) -> Result<Scale, E> {
                self.visit_f64(value as f64)
            }
            fn visit_u64<E: Error>(self, value: u64) -> Result<Scale, E> {
                self.visit_f64(value as f64)
            }
            fn visit_seq<A: SeqAccess<'de>>(self, sequence: A) -> Result<Scale, A::Error> {
                let factors = <[Number; 3]>::deserialize(SeqAccessDeserializer::new(sequence))?;
                Ok(Scale(DVec3::from_array(factors.map(Number::get))))
            }
        }
        deserializer.deserialize_any(ScaleVisitor)
    }
}

/// The payload of `!rotate`.
#[derive(Clone, Copy)]
pub(super) struct Rotation {
    /// Unit length.
    axis: DVec3,
    radians: f64,
}

#[derive(Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct RotationKeys {
    axis: Vector,
    degrees: Number,
}

impl<'de> Deserialize<'de> for Rotation {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        mapping::<_, RotationKeys, _>(
            deserializer,
            "a rotation: a mapping with the keys `axis` and `degrees`",
        )
    }
}

impl TryFrom<RotationKeys> for Rotation {
    type Error = String;
    fn try_from(keys: RotationKeys) -> Result<Self, String> {
        let axis = keys.axis.double().try_normalize().ok_or("the axis of a rotation must not be zero")?;
        Ok(Self { axis, radians: keys.degrees.get().to_radians() })
    }
}

impl Rotation {
    /// As a unit quaternion, rounded once.
    pub(super) fn quaternion(self) -> Quat {
        DQuat::from_axis_angle(self.axis, self.radians).as_quat()
    }
}

/// The payload of `!matrix`.
#[derive(Clone, Copy, Deserialize)]
#[serde(try_from = "[Number; 16]")]
pub(super) struct Matrix(DAffine3);

impl TryFrom<[Number; 16]> for Matrix {
    type Error = String;
    fn try_from(numbers: [Number; 16]) -> Result<Self, String> {
        let n = numbers.map(Number::get);
        if n[12..] != [0.0, 0.0, 0.0, 1.0] {
            return Err("the last row of a matrix must be 0, 0, 0, 1".into());
        }
        let columns = [[n[0], n[4], n[8]], [n[1], n[5], n[9]], [n[2], n[6], n[10]], [n[3], n[7], n[11]]];
        Ok(Self(DAffine3::from_cols_array_2d(&columns)))
    }
}

/// A transform of positions and normals.
pub(super) struct Placement {
    affine: DAffine3,
    normals: DMat3,
    /// True if the transform includes a reflection, which reverses orientations.
    pub(super) mirrors: bool,
}

impl Placement {
    /// `affine` must be invertible.
    pub(super) fn new(affine: DAffine3) -> Self {
        let normals = affine.matrix3.inverse().transpose();
        Self { affine, normals, mirrors: affine.matrix3.determinant() < 0.0 }
    }

    /// Transforms a position to world space, rounded once.
    pub(super) fn position(&self, position: Vec3) -> Vec3 {
        self.affine.transform_point3(position.as_dvec3()).as_vec3()
    }

    /// Transforms a normal of any length to a unit normal in world space, by the inverse transpose; `None` for length zero.
    pub(super) fn normal(&self, normal: Vec3) -> Option<Vec3> {
        // Normalized first: the square of a very small vector underflows.
        let normal = normal.as_dvec3().try_normalize()?;
        (self.normals * normal).try_normalize().map(|normal| normal.as_vec3())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_normal_stays_perpendicular_under_uneven_scaling() {
        let placement = Placement::new(DAffine3::from_scale(DVec3::new(4.0, 1.0, 0.5)));
        let along = Vec3::new(1.0, -1.0, 0.0);
        let normal = placement.normal(Vec3::new(1.0, 1.0, 0.0)).expect("it has a direction");
        let along = placement.position(along) - placement.position(Vec3::ZERO);
        assert!(normal.dot(along).abs() < 1e-6, "{normal} {along}");
        assert!((normal.length() - 1.0).abs() < 1e-6);
    }

    #[test]
    fn a_small_but_invertible_matrix_is_not_singular() {
        assert!(!is_singular(DMat3::from_diagonal(DVec3::splat(1e-20))));
        assert!(is_singular(DMat3::from_diagonal(DVec3::new(1.0, 0.0, 1.0))));
        assert!(is_singular(DMat3::from_cols(DVec3::X, DVec3::new(1.0, 1e-15, 0.0), DVec3::Z)));
    }
}
