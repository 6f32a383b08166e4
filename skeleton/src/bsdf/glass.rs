//! Smooth glass: reflection and refraction by Fresnel's and Snell's laws.
//!
//! # Radiance crossing the surface
//! A bundle of light is squeezed or widened as it is refracted, and its radiance grows or falls with the squared
//! index of refraction: L/n² is what is kept (Veach's thesis, 1997, section 5.2). The direction `wo` looks from a
//! medium of index n_o, the refracted one `wi` into one of index n_i, so what is seen is L_i · (n_o / n_i)². That
//! factor is part of `f` here. Light that enters and leaves again has lost nothing; a camera inside glass sees
//! n² L.

use super::mirror::delta_sample;
use super::{BsdfSample, LocalGeometry, fresnel_dielectric};
use crate::math::{Rgb, reflect, refract};
use crate::sampler::Sampler;

#[derive(Clone, Copy, Debug)]
pub(crate) struct Glass {
    /// The index of refraction on the viewer's side divided by the one behind the surface.
    pub(crate) ratio: f32,
    pub(crate) reflectance: Rgb,
    pub(crate) transmittance: Rgb,
}

impl Glass {
    /// One of the two directions, chosen with the probability that Fresnel's law gives it.
    #[inline]
    pub(super) fn sample(&self, geometry: &LocalGeometry, sampler: &mut Sampler) -> Option<BsdfSample> {
        let LocalGeometry { normal, geometric_normal, wo } = *geometry;
        let refracted = refract(wo, normal, self.ratio);
        let reflected_share = refracted
            .map_or(1.0, |(_, cos_t)| fresnel_dielectric(normal.dot(wo).max(0.0), cos_t, self.ratio));
        let choice = sampler.draw();
        match refracted {
            Some((wi, _)) if choice >= reflected_share => {
                let share = 1.0 - reflected_share;
                let factor = self.transmittance * (share * self.ratio * self.ratio);
                delta_sample(geometry, wi, factor, share).filter(|_| geometric_normal.dot(wi) < 0.0)
            }
            _ => {
                let wi = reflect(wo, normal).normalize();
                delta_sample(geometry, wi, self.reflectance * reflected_share, reflected_share)
                    .filter(|_| geometry.reflects(wi))
            }
        }
    }
}
