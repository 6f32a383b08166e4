//! What paths find when they hit a light.

use crate::math::Rgb;

/// The radiance that a light shows to paths that hit it. It is stored apart from the radiance of light samples, so that a
/// scene in which it is black contains no other value for it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HitRadiance(Rgb);

impl HitRadiance {
    /// Black: only light samples find the light.
    pub(crate) const BLACK: Self = Self(Rgb::BLACK);

    #[inline]
    pub(crate) fn new(radiance: Rgb) -> Self {
        Self(radiance)
    }

    /// The stored radiance, whatever light samples find.
    #[inline]
    pub(crate) fn get(self, _: Rgb) -> Rgb {
        self.0
    }
}
