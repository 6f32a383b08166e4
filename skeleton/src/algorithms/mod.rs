//! The algorithms that the program offers.

pub mod render_debug;
pub mod render_pt;
