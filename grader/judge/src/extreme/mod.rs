//! Scenes at the ends of what numbers can be, and what a program makes of them.

pub mod answers;
pub mod measure;
