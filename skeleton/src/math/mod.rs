//! Colours, vectors, directions, and sampling routines.

mod direction;
mod frame;
mod rgb;
mod trigonometry;
pub mod warp;

pub use direction::{direction_and_distance, reflect, refract};
pub use frame::Frame;
pub use glam::{Vec2, Vec3};
pub use rgb::Rgb;
