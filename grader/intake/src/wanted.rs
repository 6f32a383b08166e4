//! What is looked for in a submission.

use serde::{Deserialize, Serialize};
use verdict::rubric::StudentFile;

/// What is looked for in a submission.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Wanted {
    /// Name of the source file, ending in `.rs`.
    pub file_name: String,
    /// Name of a type that it defines. Other files of the framework only use it.
    pub type_name: String,
    /// Text of the starting file, or empty: a file equal to it counts only if there is no other source.
    pub starter: String,
}

impl Wanted {
    /// The student's file of an assignment with this starting file.
    pub fn new(file: &StudentFile, starter: &str) -> Self {
        Self {
            file_name: file.name().to_owned(),
            type_name: file.contract.type_name().to_owned(),
            starter: starter.to_owned(),
        }
    }
}
