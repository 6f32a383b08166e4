//! Grading a whole class.
//!
//! [`layout`] finds the submissions in a folder, [`roster`] reads the students, [`Class`] combines both. [`run`()] takes
//! in and grades several submissions at once, and stores a [`record`] of each when it is done. [`gradebook`] makes tables
//! of the records, penalties included; [`systems`] fills the tables of Moodle and ILIAS; [`page`] shows the class;
//! [`similar`] lists submissions that are the same or nearly so, for a tutor to look at.
//!
//! Points of a record are raw. Everything that depends on a date is computed each time that tables are written.

mod changes;
mod comments;
mod directory;
pub mod feedback;
mod find;
pub mod gradebook;
mod identity;
mod inputs;
pub mod layout;
pub mod lookup;
mod members;
mod merge;
mod names;
pub mod page;
mod pages;
mod plausible;
mod progress;
pub mod record;
pub mod roster;
mod run;
mod settle;
pub mod shard;
pub mod similar;
pub mod systems;
mod tokens;

pub use members::{Class, Member};
pub use merge::merge;
pub use plausible::Accepted;
pub use run::has_results;
pub use run::{Outcome, RunOptions, run};
