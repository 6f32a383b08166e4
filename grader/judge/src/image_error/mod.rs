//! Image error metrics for reports and plots.
//!
//! They never decide about correctness, since they do not separate noise from bias. Pictures are lists of pixels with
//! three linear channels, row by row from the top.
//!
//! The squared errors are those of the renderer ([`arty::image::error`]), since students plot them, too.

pub mod flip;

pub use arty::image::error::{Truth, mse, relative_mse, relative_weight, trimmed_relative_mse};
pub use flip::{HdrFlip, hdr_flip};
