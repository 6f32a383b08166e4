//! A small physically based renderer for teaching light transport.

pub mod accel;
pub mod math;
pub mod scene;
