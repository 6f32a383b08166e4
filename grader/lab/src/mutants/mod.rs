//! Does the grader see what it should see? Submissions whose mistakes are known, and right ones in many styles.
//!
//! [`variants`] are the solution with something changed: [`Kind::Wrong`] ones must lose points in the tasks that
//! their mistake breaks and in no other, [`Kind::Right`] ones must lose none. [`Ledger`] grades them and keeps the
//! results, [`Outcome`] compares those with what was expected, [`table`] shows all of it.

mod ledger;
mod outcome;
mod table;
mod variant;

pub use ledger::{Ledger, Record, hash_of_inputs};
pub use outcome::Outcome;
pub use table::table;
pub use variant::{Kind, NotPossible, Variant, Variants, variants};
