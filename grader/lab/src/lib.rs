//! The laboratory: measures the grader itself, for staff.
//!
//! [`mutants`] grades right and wrong variants of the solution, [`calibration`] measures false alarms and power,
//! [`limits`] sweeps sizes, distances and radiances until numbers break, [`handout`] makes what students get.

pub mod calibration;
pub mod commands;
pub mod handout;
pub mod limits;
pub mod mutants;
