//! Decides whether a submission is right, and how surely: statistics, references, checks, grades and diagnoses.
//!
//! [`checks`] request numbers from a submission and compare them with [`mod@reference`]s or closed forms, using
//! [`statistics`]; [`mod@plan`] says where each check applies; [`mod@grade`] turns verdicts into points; [`diagnosis`]
//! finds likely causes. [`convergence`] measures error against run time, which does not affect points.

pub mod audit;
pub mod checks;
pub mod convergence;
pub mod diagnosis;
pub mod extreme;
pub mod grade;
pub mod image_error;
pub mod pictures;
pub mod plan;
pub mod reference;
pub mod replay;
pub mod scenes;
pub mod statistics;
