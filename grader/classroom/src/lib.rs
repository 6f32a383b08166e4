//! Grading a whole class: rosters, deadlines, tutors' marks, gradebooks, and the tables of course systems.

pub mod class;
pub mod lock;
pub mod marks;
pub mod policy;
pub mod table;
