//! What of a hand-in is graded.

use std::path::{Path, PathBuf};

use crate::error::{Error, Result};
use crate::intake;

/// The name of the one file that counts.
pub const FILE_NAME: &str = "render_pt.rs";

/// A hand-in's source.
#[derive(Clone, Debug)]
pub struct Submission {
    /// The path as it was given.
    pub path: PathBuf,
    /// The text of its `render_pt.rs`, with lines that end in `\n`.
    pub source: String,
}

impl Submission {
    /// Reads a hand-in that somebody named: a source under any name, a folder, an archive or a git repository.
    ///
    /// # Errors
    /// If there is nothing to grade in it; [`intake::take`] tells more.
    pub fn read(path: &Path) -> Result<Self> {
        intake::take(&[path.to_owned()], "")?.outcome.map_err(|refusal| Error::file(path, refusal))
    }

    /// BLAKE3 of the source, in hexadecimal.
    pub fn hash(&self) -> String {
        blake3::hash(self.source.as_bytes()).to_hex().to_string()
    }
}
