//! Stands in for `probe` in every build without that feature: the same names, zero-sized and without effect.
//!
//! Scripts are types without values, so `Option<ScriptedLight>` takes no space and is always `None`.

use crate::math::{Rgb, Vec3};

/// No BSDF is scripted in this build.
#[derive(Clone, Copy, Debug)]
pub(crate) enum ScriptedBsdf {}

/// No light is scripted in this build.
#[derive(Clone, Copy, Debug)]
pub(crate) enum ScriptedLight {}

/// Paths that hit a light find what light samples find.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HitRadiance;

/// A call that is not recorded.
pub(crate) struct Call;

impl ScriptedBsdf {
    pub(crate) fn target(&self) -> Vec3 {
        match *self {}
    }

    pub(crate) fn is_delta(&self) -> bool {
        match *self {}
    }

    pub(crate) fn samples_delta(&self) -> bool {
        match *self {}
    }

    pub(crate) fn samples_nothing(&self) -> bool {
        match *self {}
    }

    pub(crate) fn sampled(&self) -> (Rgb, f32) {
        match *self {}
    }

    pub(crate) fn of_direction(&self, _: Vec3, _: Vec3, _: Vec3) -> (Rgb, f32) {
        match *self {}
    }
}

impl ScriptedLight {
    pub(crate) fn point(&self) -> Vec3 {
        match *self {}
    }

    pub(crate) fn pdf_area(&self) -> f32 {
        match *self {}
    }

    pub(crate) fn pdf_area_on_hit(&self) -> f32 {
        match *self {}
    }

    pub(crate) fn is_bright_from(&self, _: Vec3) -> bool {
        match *self {}
    }
}

impl HitRadiance {
    #[inline]
    pub(crate) fn new(_: Rgb) -> Self {
        Self
    }

    #[inline]
    pub(crate) fn get(self, sampled: Rgb) -> Rgb {
        sampled
    }
}

impl Call {
    pub(crate) fn new(_: &'static str) -> Self {
        Self
    }

    pub(crate) fn given<T>(self, _: &'static str, _: T) -> Self {
        self
    }

    pub(crate) fn got<T>(self, _: &'static str, _: T) -> Self {
        self
    }
}

#[inline]
pub(crate) fn record(_: impl FnOnce() -> Call) {}

#[inline]
pub(crate) fn count_ray() {}

#[inline]
pub(crate) fn count_shadow_ray() {}

#[inline]
pub(crate) fn count_light_sample() {}

#[inline]
pub(crate) fn stratified(number: f32) -> f32 {
    number
}
