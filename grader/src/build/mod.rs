//! From a hand-in's source to a program.

mod compile;
mod framework;
mod scratch;

pub(crate) use compile::EMPTY_HAND_IN;
pub use compile::{BuildFailure, HandInProgram, compile};
pub use framework::Framework;
