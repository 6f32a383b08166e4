//! When a submission counts, and how much.
//!
//! The rules of the sheet ([`Rules`]) stand in the rubric; the dates of a course and the extensions of its students
//! ([`Course`]) in a file of the course's own, since they change each term and concern nobody else. Both together are
//! a [`Policy`]. When a submission came is told by the staff's side alone ([`Manifest`]), never by the times of files.
//! Raw points are what is stored; the penalty is computed from them and the policy each time that a table is made.

mod course;
mod judge;
mod manifest;

mod time;

pub use course::{Course, Extension};
pub use judge::{Lateness, Policy, Standing};
pub(crate) use manifest::the_one_that_counts;
pub use manifest::{Manifest, Receipt};

pub use time::parse_received;
pub use verdict::rubric::{LateRule, Md5Rule, Rules, zone};
