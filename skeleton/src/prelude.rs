//! Everything an integrator needs: `use arty::prelude::*;`.

pub use crate::bsdf::{Bsdf, BsdfSample};
pub use crate::integrator::{Integrator, Settings, Technique};
pub use crate::light::{DirectSample, Emission, Light};
pub use crate::math::{Frame, Rgb, Vec3, direction_and_distance};
pub use crate::ray::Ray;
pub use crate::sampler::Sampler;
pub use crate::scene::{Hit, Scene};
