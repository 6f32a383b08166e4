//! The written explanation, which a person marks.

use serde::{Deserialize, Serialize};

use super::names::base;
use super::text::decode;

/// What kind of file an explanation is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ExplanationKind {
    /// `.txt` or `.md`: its text is kept.
    Text,
    /// `.pdf`, or a text that cannot be read: only its name, size and hash are kept.
    Binary,
}

/// A written explanation.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Explanation {
    /// Its name in the hand-in.
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

impl Explanation {
    /// Keeps what is needed of a file.
    pub(super) fn new(name: &str, bytes: &[u8]) -> Self {
        let is_pdf = base(name).to_lowercase().ends_with(".pdf");
        let text = if is_pdf { None } else { decode(bytes, &mut Vec::new()).ok() };
        Self {
            name: name.to_owned(),
            kind: if text.is_some() { ExplanationKind::Text } else { ExplanationKind::Binary },
            bytes: bytes.len(),
            hash: blake3::hash(bytes).to_hex().to_string(),
            text,
        }
    }

    /// True for texts that come with the project or its tools, and that a student who sends all of it sends along.
    pub(super) fn is_ordinary(&self) -> bool {
        let name = base(&self.name).to_lowercase();
        let ordinary = ["readme", "architecture", "sheet", "kill-matrix", "license", "licence", "cmakelists"];
        ordinary.iter().any(|start| name.starts_with(start))
    }
}
