//! Extreme scenes, near the limits of single precision, and measuring programs in them.

pub mod answers;
pub mod measure;
