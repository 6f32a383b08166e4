//! Everything an integrator needs: `use arty::prelude::*;`.
//!
//! **Start here.** In the order in which a path meets them:
//!
//! 1. [`Scene::intersect`] finds what a ray hits: a [`Hit`], with [`Hit::emission`], [`Hit::bsdf`] and [`Hit::spawn`].
//! 2. [`Scene::lights`] lists the lights; [`Light::sample_direct`] samples a point on one of them: a [`DirectSample`].
//! 3. [`Scene::occluded`] tells whether something lies between a hit and that point.
//! 4. [`Bsdf::eval`], [`Bsdf::pdf`] and [`Bsdf::sample`] tell how the surface scatters light: a [`BsdfSample`].
//! 5. [`Scene::environment`] is the light from outside of the scene, where there is any: an [`Environment`].
//!    [`Scene::occluded_towards`] tells whether something keeps it from a hit.
//! 6. [`Sampler::next_1d`] and [`Sampler::next_2d`] are the only source of random numbers.

#[doc(inline)]
pub use crate::bsdf::{Bsdf, BsdfSample};
#[doc(inline)]
pub use crate::environment::{DirectionSample, Environment, SampleDirections};
#[doc(inline)]
pub use crate::integrator::{Integrator, Settings, Technique};
#[doc(inline)]
pub use crate::light::{DirectSample, Emission, Light};
#[doc(inline)]
pub use crate::math::{Frame, Rgb, Vec3, direction_and_distance};
#[doc(inline)]
pub use crate::ray::Ray;
#[doc(inline)]
pub use crate::sampler::Sampler;
#[doc(inline)]
pub use crate::scene::{Hit, Scene};
