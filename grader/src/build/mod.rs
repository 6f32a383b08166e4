//! From a hand-in's source to a program.

mod compile;
mod framework;

pub use compile::{BuildFailure, HandInProgram, compile};
pub use framework::Framework;
