//! Warnings without duplicates.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use crate::diagnostic::Diagnostic;

/// Warnings about input files.
#[derive(Default)]
pub(super) struct Warnings {
    warnings: Vec<Diagnostic>,
    topics: HashSet<(PathBuf, String)>,
}

impl Warnings {
    /// Adds a warning unless it is a duplicate: a file may be read twice.
    pub(super) fn add(&mut self, warning: Diagnostic) {
        let topic = format!("{:?} {}", warning.line, warning.message);
        self.once((&warning.file.clone(), &topic), warning);
    }

    /// Adds a warning unless there is already one for this file and topic.
    pub(super) fn once(&mut self, (file, topic): (&Path, &str), warning: Diagnostic) {
        if self.topics.insert((file.to_owned(), topic.to_owned())) {
            self.warnings.push(warning);
        }
    }

    /// All warnings, in the order in which they were added.
    pub(super) fn into_vec(self) -> Vec<Diagnostic> {
        self.warnings
    }
}
