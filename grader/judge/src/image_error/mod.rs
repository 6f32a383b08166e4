//! How far a picture is from a reference, in one number: for reports and plots.
//!
//! Correctness is never judged by these: they do not tell noise from bias. Pictures are lists of pixels, row by row
//! from the top, three linear channels each.
//!
//! The squared errors are the renderer's own ([`arty::image::error`]), since students plot them too.

pub mod flip;

pub use arty::image::error::{Truth, mse, relative_mse, relative_weight, trimmed_relative_mse};
pub use flip::{HdrFlip, hdr_flip};
