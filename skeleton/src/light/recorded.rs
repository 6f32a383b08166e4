//! Calls that concern lights as the grader's replay records them.
//!
//! None of these functions is inlined, or every submission would compile them again.

use super::{DirectSample, Emission, Light};
use crate::math::Vec3;
use crate::probe::Call;

pub(super) fn sample_direct(light: &Light, from: Vec3, sample: Option<DirectSample>) -> Call {
    let call = Call::new("Light::sample_direct").given("light", light.index).given("from", from);
    let Some(DirectSample { point, emitted, pdf_area, cos_light }) = sample else { return call };
    call.got("point", point).got("emitted", emitted).got("pdf_area", pdf_area).got("cos_light", cos_light)
}

pub(crate) fn emission(point: Vec3, emission: &Emission<'_>) -> Call {
    let Emission { light, radiance, pdf_area, cos_light } = *emission;
    Call::new("Hit::emission")
        .given("point", point)
        .got("light", light.index)
        .got("radiance", radiance)
        .got("pdf_area", pdf_area)
        .got("cos_light", cos_light)
}
