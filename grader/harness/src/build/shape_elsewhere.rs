//! Programs of systems that have no sandbox for us: they are not looked at.

use std::path::Path;

use verdict::error::Result;

/// The shape of a program: not known here.
#[derive(Clone, Debug)]
pub(crate) struct Shape;

impl Shape {
    /// Looks at a program.
    ///
    /// # Errors
    /// None here.
    pub(crate) fn of(_: &Path) -> Result<Self> {
        Ok(Self)
    }

    /// In what it differs from the program of an empty submission: in nothing, here.
    pub(crate) fn differences(&self, _: &Self) -> Vec<String> {
        Vec::new()
    }
}
