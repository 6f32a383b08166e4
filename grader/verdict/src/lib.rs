//! The data of a grade: the rubric, the measurements and the points. Nothing here runs or judges a submission.
//!
//! A [`rubric`] names the checks of an assignment and their points. A [`report`] holds one grade of a
//! [`submission`]; every page, table and export is made from it. [`edition`] removes what students must not see before
//! any format is written.

pub mod audit;
pub mod check;
pub mod convergence;
pub mod edition;
pub mod error;
pub mod next;
pub mod number;
pub mod output;
pub mod pictures;
pub mod replay;
pub mod report;
pub mod rubric;
#[cfg(any(test, feature = "sample"))]
pub mod sample;
pub mod sandbox;
pub mod schema;
mod smape;
pub mod submission;
pub mod text;
