//! Mutation testing of the grader: submissions with known mistakes, and correct ones in many styles.
//!
//! [`variants`] are mostly edits of the solution: [`Kind::Wrong`] ones must lose points in the tasks that their mistake
//! breaks and in no other, [`Kind::Right`] ones must lose none. [`Ledger`] grades them and keeps the results,
//! [`Outcome`] compares those with the expectation, [`table`] makes the kill matrix, and [`learn`] turns the grades into
//! signatures for the diagnosis.

mod learn;
mod ledger;
mod outcome;
mod table;
mod variant;

pub use learn::{Learnt, learn};
pub use ledger::{Ledger, Record, hash_of_inputs};
pub(crate) use ledger::{REPORTS, RESULTS, report_name};
pub use outcome::Outcome;
pub use table::table;
pub use variant::{Kind, NotPossible, Variant, Variants, variants};
