//! A small physically based renderer for teaching light transport.

#[cfg(feature = "files")]
pub mod image;
pub mod math;
pub mod scene;
