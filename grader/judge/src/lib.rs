//! What is right, and how sure that is: statistics, references, checks, grades, diagnoses.
//!
//! [`checks`] ask a submission for numbers and judge them with [`statistics`] against [`mod@reference`]s or closed
//! forms; [`mod@plan`] says where each check means something; [`mod@grade`] turns verdicts into points; [`diagnosis`]
//! finds likely causes. [`convergence`] measures error against run time, for no points.

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
