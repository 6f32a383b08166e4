//! A perfect mirror.

use super::{BsdfSample, LocalGeometry};
use crate::math::{Rgb, reflect};

/// The mirrored direction. `None` if it is below the geometric horizon, which is possible with interpolated normals, or if
/// nothing is reflected.
#[inline]
pub(super) fn sample(geometry: &LocalGeometry, reflectance: Rgb) -> Option<BsdfSample> {
    let wi = reflect(geometry.wo, geometry.normal).normalize();
    delta_sample(geometry, wi, reflectance, 1.0).filter(|_| geometry.reflects(wi))
}

/// A sample of a delta lobe that scales radiance by `factor`, selected with the given probability.
#[inline]
pub(super) fn delta_sample(
    geometry: &LocalGeometry,
    wi: crate::math::Vec3,
    factor: Rgb,
    probability: f32,
) -> Option<BsdfSample> {
    let cos = geometry.normal.dot(wi).abs();
    let f = factor / cos;
    // At grazing incidence the division by the cosine overflows.
    (probability > 0.0 && f.is_finite() && !f.is_black()).then_some(BsdfSample {
        wi,
        f,
        pdf: probability,
        cos,
        is_delta: true,
    })
}
