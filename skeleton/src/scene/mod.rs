//! The scene.

mod description;
mod diagnostic;

pub use description::*;
pub use diagnostic::Diagnostic;
