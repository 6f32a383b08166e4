//! Smooth glass: reflection and refraction by the laws of Fresnel and Snell.
//!
//! # Radiance across the interface
//! Refraction changes the solid angle of a beam, and its radiance scales with the squared index of refraction: L/n² is
//! invariant (Veach's thesis, 1997, section 5.2). With `wo` in a medium of index n_o and the refracted `wi` in one of index
//! n_i, the transmitted radiance is L_i · (n_o / n_i)². This factor is part of `f`. Light that enters and leaves loses
//! nothing; a camera inside glass sees n² L.

use super::mirror::delta_sample;
use super::{BsdfSample, LocalGeometry, fresnel_dielectric};
use crate::math::{Rgb, reflect, refract};
use crate::sampler::Sampler;

#[derive(Clone, Copy, Debug)]
pub(crate) struct Glass {
    /// Index of refraction on the viewer's side divided by the one on the other side.
    pub(crate) ratio: f32,
    pub(crate) reflectance: Rgb,
    pub(crate) transmittance: Rgb,
}

impl Glass {
    /// Samples reflection or refraction, with the Fresnel reflectance as the probability of reflection.
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
