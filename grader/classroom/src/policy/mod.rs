//! The late policy: which submissions count, and how much.
//!
//! [`Rules`] are part of the rubric. The dates of a course and the extensions of its students ([`Course`]) are in a file
//! of their own, since they change each term. Both together are a [`Policy`]. Receipt times come from the staff
//! ([`Manifest`]), never from the times of files. Only raw points are stored; penalties are computed each time that a
//! table is written.

mod course;
mod judge;
mod manifest;

mod time;

pub use course::{Course, Extension};
pub(crate) use judge::points_after;
pub use judge::{Lateness, Policy, Standing};
pub(crate) use manifest::the_one_that_counts;
pub use manifest::{Manifest, Receipt};

pub use time::parse_received;
pub use verdict::rubric::{LateRule, Md5Rule, Rules, zone};
