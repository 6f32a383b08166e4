//! The calls that an integrator made for one sample.

use std::borrow::Cow;

use arty::math::{Rgb, Vec3};

/// The calls for one sample, and the radiance that it returned.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedPath {
    /// Number of the sample.
    pub sample: u64,
    /// The radiance that the integrator returned.
    pub radiance: Rgb,
    /// The calls, in order.
    pub calls: Vec<Call>,
}

/// One call, with named numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Call {
    /// The function, such as `Scene::intersect`.
    pub function: &'static str,
    /// Arguments.
    pub given: Vec<(Cow<'static, str>, Vec<f32>)>,
    /// Results; empty for `None`.
    pub got: Vec<(Cow<'static, str>, Vec<f32>)>,
}

impl Call {
    /// A result that is a number.
    pub(super) fn number(&self, name: &str) -> Option<f32> {
        find(&self.got, name)?.first().copied()
    }

    /// A result that is a point or a direction.
    pub(super) fn vector(&self, name: &str) -> Option<Vec3> {
        find(&self.got, name)?.try_into().ok().map(Vec3::from_array)
    }

    /// A result that is a colour.
    pub(super) fn color(&self, name: &str) -> Option<Rgb> {
        <[f32; 3]>::try_from(find(&self.got, name)?).ok().map(Rgb::from)
    }

    /// An argument that is a point or a direction.
    pub(super) fn given(&self, name: &str) -> Option<Vec3> {
        find(&self.given, name)?.try_into().ok().map(Vec3::from_array)
    }
}

fn find<'a>(values: &'a [(Cow<'static, str>, Vec<f32>)], name: &str) -> Option<&'a [f32]> {
    values.iter().find(|(other, _)| *other == name).map(|(_, numbers)| numbers.as_slice())
}
