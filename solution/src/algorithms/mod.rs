//! The algorithms of the program: the student's file completed, everything else from the skeleton.

#[path = "../../../skeleton/src/algorithms/render_debug.rs"]
pub mod render_debug;
pub mod render_pt;
