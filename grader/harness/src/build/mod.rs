//! From a hand-in's source to a program.

mod cargo;
mod compile;
mod compiler;
mod framework;
mod kept;
mod scratch;

pub use compile::{EMPTY_HAND_IN, recipe};
pub use compile::{HandInProgram, compile};
pub use framework::Framework;
