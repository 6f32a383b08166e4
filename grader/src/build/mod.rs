//! From a hand-in's source to a program.

mod compile;
mod framework;
mod scratch;

pub use compile::{BuildFailure, HandInProgram, compile};
pub(crate) use compile::{EMPTY_HAND_IN, recipe};
pub use framework::Framework;
