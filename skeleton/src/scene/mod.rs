//! The scene.

mod description;
mod diagnostic;
#[cfg(feature = "files")]
pub mod file;

pub use description::*;
pub use diagnostic::Diagnostic;
