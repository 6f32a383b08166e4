//! Telling a biased estimator from a noisy one.
//!
//! The unit of observation is a **batch**: an independent rendering with its own seed. [`batches`] gathers them,
//! [`regions`] pools pixels into tiles at several scales, [`bias`] asks of each tile whether its mean is what it
//! should be, and [`sequential`] decides when enough has been seen.

pub mod batches;
pub mod bias;
#[cfg(test)]
mod extremes;
pub mod independence;
pub mod regions;
pub mod regression;
pub mod sequential;
pub mod variance;
