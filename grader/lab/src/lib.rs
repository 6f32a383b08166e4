//! The laboratory: measures the grader itself, for staff.
//!
//! [`mutants`] grades right and wrong variants of the solution and [`compare`] tells two such sets of grades apart,
//! [`calibration`] measures false alarms and power, [`coverage`] how often intervals of error curves hold the truth,
//! [`limits`] the numerical range of the renderer, [`facts`] learns which facts fail for which mistake, [`figures`]
//! renders the figures of the sheet, [`handout`] makes what students get, and [`new_assignment`] begins another sheet.

pub mod calibration;
pub mod commands;
pub mod compare;
pub mod coverage;
pub mod facts;
pub mod figures;
pub mod handout;
pub mod limits;
pub mod mutants;
pub mod new_assignment;
pub mod output;
