//! Measures convergence: the error of programs against run time, beside that of the solution.
//!
//! The method is described at [`verdict::convergence`].
//!
//! Convergence neither earns nor costs points.

mod bias;
mod brief;
mod crops;
mod curve_run;
mod jackknife;
mod measure;
mod panel;
mod plan;
mod tally;
#[cfg(test)]
mod tests;

pub use brief::brief;
pub use crops::crops;
pub use measure::{MeasuredProgram, Options, measure};
