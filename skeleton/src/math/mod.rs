//! Colours, vectors, directions, and sampling routines.

mod direction;
mod frame;
mod non_finite;
mod rgb;
mod trigonometry;
pub mod warp;

pub use direction::{direction_and_distance, reflect, refract};
pub use frame::Frame;
pub use glam::{Vec2, Vec3};
pub use non_finite::first_non_finite_sum;
pub(crate) use non_finite::forget_sums;
pub use rgb::Rgb;
