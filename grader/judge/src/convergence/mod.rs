//! Measures convergence: the error of programs against run time, beside that of the solution.
//!
//! The method is described at [`verdict::convergence`].
//!
//! Convergence neither earns nor costs points.

mod brief;
mod crops;
mod curve_run;
mod estimate;
mod measure;
mod summary;

pub use brief::brief;
pub use crops::crops;
pub use measure::{MeasuredProgram, Options, measure};
