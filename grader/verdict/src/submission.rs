//! A submission as it is graded, and what intake found in it.

use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};

/// The source of a submission.
#[derive(Clone, Debug)]
pub struct Submission {
    /// Its path as given on the command line.
    pub path: PathBuf,
    /// Text of its source, with `\n` line endings.
    pub source: String,
}

impl Submission {
    /// Reads a source file written by staff. Submissions of students go through the crate `intake`.
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
    /// rustc's messages as shown on a terminal without colours. Line numbers are those of the submission.
    pub messages: String,
    /// Line of the first error in the submission, counted from 1; `None` if rustc names none.
    pub line: Option<u32>,
}

/// File type of a written explanation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ExplanationKind {
    /// `.txt` or `.md`: the text is kept.
    Text,
    /// `.pdf`, or text that is not UTF-8: only name, size and hash are kept.
    Binary,
}

/// A written explanation that was sent with a submission.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Explanation {
    /// File name in the submission.
    pub name: String,
    /// File type.
    pub kind: ExplanationKind,
    /// Size in bytes.
    pub bytes: usize,
    /// BLAKE3 of the bytes, in hexadecimal.
    pub hash: String,
    /// The text; `None` for a binary file.
    pub text: Option<String>,
}

/// A note or refusal of intake: a code and a sentence.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct IntakeFinding {
    /// Code in kebab-case, such as `missing-file`.
    pub code: String,
    /// The finding as a sentence.
    pub message: String,
}

/// Something in the source that the sandbox refuses.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct SourceFinding {
    /// Line of the submission, counted from 1.
    pub line: usize,
    /// What the line names, such as `std::fs`.
    pub what: String,
    /// Why it does not work.
    pub why: String,
}
