//! Fingerprints of a class, kept to compare the submissions of later years with. They hold no source.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::Fingerprint;
use crate::class::record::ResultDir;
use verdict::error::{Error, Result};
use verdict::output;

/// Version of the format; a change of how fingerprints are computed is another version.
const SCHEMA: &str = "arty-fingerprints/1";

/// Fingerprints of a class.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Archive {
    schema: String,
    /// Name of the assignment.
    pub assignment: String,
    /// Fingerprints, by row key.
    pub fingerprints: BTreeMap<String, Fingerprint>,
}

/// Submissions of earlier years.
#[derive(Clone, Debug, Default)]
pub struct Earlier {
    /// Fingerprints, by the name of the year's folder or file and the student's key.
    pub fingerprints: BTreeMap<String, Fingerprint>,
    /// Sources of those whose results were kept.
    pub sources: BTreeMap<String, PathBuf>,
}

impl Archive {
    /// Fingerprints of a class.
    pub fn new(assignment: &str, fingerprints: BTreeMap<String, Fingerprint>) -> Self {
        Self { schema: SCHEMA.to_owned(), assignment: assignment.to_owned(), fingerprints }
    }

    /// Path in the results of a class.
    pub fn path(out: &Path) -> PathBuf {
        out.join("fingerprints.json")
    }

    /// Saves it.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn save(&self, out: &Path) -> Result<()> {
        output::write_json(&Self::path(out), self)
    }

    /// Reads an archive of an assignment: the file, or the results of a class that hold it.
    ///
    /// # Errors
    /// If it cannot be read, or is of another version or assignment.
    pub fn load(path: &Path, assignment: &str) -> Result<Self> {
        let file = if path.is_dir() { Self::path(path) } else { path.to_owned() };
        let bytes = std::fs::read(&file).map_err(|error| Error::file(&file, error))?;
        let archive: Self = serde_json::from_slice(&bytes).map_err(|error| Error::file(&file, error))?;
        let trouble = if archive.schema != SCHEMA {
            format!("this is {}, not {SCHEMA}: grade that class again with --resume", archive.schema)
        } else if archive.assignment != assignment {
            format!("these are submissions of {}, not of {assignment}", archive.assignment)
        } else {
            return Ok(archive);
        };
        Err(Error::file(&file, trouble))
    }
}

impl Earlier {
    /// Reads the archives of earlier years, and writes nothing to them.
    ///
    /// # Errors
    /// As [`Archive::load`], or if two archives have the same name.
    pub fn load(paths: &[PathBuf], assignment: &str) -> Result<Self> {
        let mut earlier = Self::default();
        for path in paths {
            let archive = Archive::load(path, assignment)?;
            // What is called fingerprints.json is called so every year.
            let is_plain = path.is_file() && path.file_name() == Archive::path(path).file_name();
            let folder = if path.is_file() { path.parent().unwrap_or(path) } else { path };
            let named = if is_plain { folder } else { path };
            let name = named.file_stem().unwrap_or(named.as_os_str()).to_string_lossy();
            for (key, print) in archive.fingerprints {
                let source = ResultDir::new(folder, &key).source();
                let full = format!("{name}/{key}");
                if source.is_file() {
                    earlier.sources.insert(full.clone(), source);
                }
                if earlier.fingerprints.insert(full, print).is_some() {
                    let remedy = format!("two archives are called {name}: rename one");
                    return Err(Error::file(path, remedy));
                }
            }
        }
        Ok(earlier)
    }
}
