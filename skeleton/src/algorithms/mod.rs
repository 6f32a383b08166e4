//! The algorithms of the program.

pub mod render_debug;
pub mod render_pt;
