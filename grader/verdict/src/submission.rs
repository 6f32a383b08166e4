//! What of a submission is graded.

use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};

/// The name of the one file that counts.
pub const FILE_NAME: &str = "render_pt.rs";

/// A submission's source.
#[derive(Clone, Debug)]
pub struct Submission {
    /// The path as it was given.
    pub path: PathBuf,
    /// The text of its `render_pt.rs`, with lines that end in `\n`.
    pub source: String,
}

impl Submission {
    /// Reads a source file that the staff wrote. What others sent goes through the crate `intake`.
    ///
    /// # Errors
    /// If it cannot be read as UTF-8.
    pub fn load_trusted(path: &Path) -> Result<Self> {
        let text = std::fs::read_to_string(path).map_err(|error| Error::file(path, error))?;
        Ok(Self { path: path.to_owned(), source: text.replace("\r\n", "\n") })
    }

    /// BLAKE3 of the source, in hexadecimal.
    pub fn hash(&self) -> String {
        blake3::hash(self.source.as_bytes()).to_hex().to_string()
    }
}

/// Why a submission does not compile.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BuildFailure {
    /// rustc's messages as it shows them on a terminal without colours; lines are those of the submission.
    pub messages: String,
    /// The line of the first error in the submission, where rustc names one.
    pub line: Option<u32>,
}

/// What kind of file an explanation is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ExplanationKind {
    /// `.txt` or `.md`: its text is kept.
    Text,
    /// `.pdf`, or a text that cannot be read: only its name, size and hash are kept.
    Binary,
}

/// A written explanation.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Explanation {
    /// Its name in the submission.
    pub name: String,
    /// Text or not.
    pub kind: ExplanationKind,
    /// Its size.
    pub bytes: usize,
    /// BLAKE3 of its bytes, in hexadecimal.
    pub hash: String,
    /// Its text, where it is one.
    pub text: Option<String>,
}

/// A note or refusal as it is stored: a code and a sentence.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct IntakeFinding {
    /// In kebab-case, as `missing-file`.
    pub code: String,
    /// The same for people.
    pub message: String,
}

/// Something that a submission names.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct SourceFinding {
    /// The line of the submission, counted from 1.
    pub line: usize,
    /// What stands there, as in `std::fs`.
    pub what: String,
    /// Why that is of no use.
    pub why: String,
}
