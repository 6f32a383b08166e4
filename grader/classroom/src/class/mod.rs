//! Grading a whole class.
//!
//! [`layout`] recognises whose submissions lie in a folder, [`roster`] who should have handed in, [`Class`] brings both
//! together, `run` takes in and grades as many at once as there are cores, and keeps a [`record`] of each as it ends.
//! [`gradebook`] makes tables of the records, the penalties of the policy included, [`systems`] fills the files of
//! Moodle and ILIAS, [`page`] shows all of it, [`similar`] lists submissions that are the same or nearly so, for a person to look at.
//!
//! A record's points are raw. Everything that a date can change is computed anew each time that tables are made.

pub mod gradebook;
pub mod layout;
mod members;
pub mod page;
mod pages;
mod progress;
pub mod record;
pub mod roster;
mod run;
pub mod similar;
pub mod systems;
mod tokens;

pub use members::{Class, Member};
pub use run::has_results;
pub use run::{Outcome, RunOptions, run};
