//! The sweeps of the framework.

mod cost;
mod rays;
mod transport;

pub use cost::{bounces, lights, triangles};
pub use rays::{offset_of_rays, scale_of_rays};
pub use transport::{Renderer, exponent, glass_index, light_distance, light_size, offset, radiance, scale};
