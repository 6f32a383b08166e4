//! A whole class: rosters, deadlines, marks, gradebooks.

pub mod class;
pub mod marks;
pub mod policy;
pub mod table;
