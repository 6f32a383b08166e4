//! The algorithms that the program offers: the student's file filled in, all else as it is in the skeleton.

#[path = "../../../skeleton/src/algorithms/render_debug.rs"]
pub mod render_debug;
pub mod render_pt;
