//! The algorithms of the program.

pub mod environment;
pub mod render_debug;
