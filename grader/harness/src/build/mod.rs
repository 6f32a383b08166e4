//! From a submission's source to a program.

mod cargo;
mod compile;
mod compiler;
mod framework;
mod kept;
mod program;
mod refuse;
mod scratch;
#[cfg(target_os = "linux")]
mod shape;
#[cfg(not(target_os = "linux"))]
#[path = "shape_elsewhere.rs"]
mod shape;

pub(crate) use compile::compile_empty;
pub use compile::{SubmissionProgram, compile, differences};
pub use framework::Framework;
pub use program::Program;
