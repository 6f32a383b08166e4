//! Calls of a BSDF as the grader's replay records them.
//!
//! None of these functions is inlined, or every submission would compile them again.

use super::BsdfSample;
use crate::math::{Rgb, Vec3};
use crate::probe::Call;

pub(super) fn eval(wi: Vec3, f: Rgb) -> Call {
    Call::new("Bsdf::eval").given("wi", wi).got("f", f)
}

pub(super) fn pdf(wi: Vec3, pdf: f32) -> Call {
    Call::new("Bsdf::pdf").given("wi", wi).got("pdf", pdf)
}

pub(super) fn sample(sample: Option<BsdfSample>) -> Call {
    let call = Call::new("Bsdf::sample");
    match sample {
        None => call,
        Some(BsdfSample { wi, f, pdf, cos, is_delta }) => {
            call.got("wi", wi).got("f", f).got("pdf", pdf).got("cos", cos).got("is_delta", is_delta)
        }
    }
}
