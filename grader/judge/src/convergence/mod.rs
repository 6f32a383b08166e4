//! Error against run time: how fast the pictures of a program become right, beside the solution's.
//!
//! Every point of a curve is many **separate** renderings of one length, each with a seed of its own: the points of
//! one progressive rendering would all share its luck. Time is processor time of the submission's process, over all of
//! its threads; programs take turns in short jobs, so that whatever else the machine does meets all of them; the first
//! jobs, from which the lengths are planned, are left out. Errors are taken against the stored reference, whose own
//! noise is subtracted; intervals are bootstrapped over renderings (Celarek et al.: "Quantifying the Error of Light
//! Transport Algorithms", 2019, on why many short renderings). Nothing here earns or costs points.
//!
//! For an unbiased program the squared error falls as 1/time: a line of slope −1 in log–log. A curve that flattens has
//! a bias, which no time takes away, or random numbers that repeat.

mod brief;
mod crops;
mod curve_run;
mod estimate;
mod measure;
mod summary;

pub use brief::brief;
pub use crops::crops;
pub use measure::{MeasuredProgram, Options, measure};
