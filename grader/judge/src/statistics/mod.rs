//! Statistical tests that distinguish a biased estimator from a noisy one.
//!
//! The unit of observation is a **batch**: an independent rendering with its own seed. [`batches`] collects them,
//! [`regions`] pools pixels into tiles at several scales, [`bias`] tests the mean of a region against what is
//! [`expected`], and [`sequential`] requests more samples until the result is clear.

pub mod batches;
pub mod bias;
pub mod expected;
pub mod independence;
pub mod regions;
pub mod regression;
pub mod sequential;
#[cfg(test)]
mod tests;
pub mod variance;
