//! What was handed in.

use std::path::{Path, PathBuf};

use crate::error::{Error, Result};

/// The name of the one file that counts.
pub const FILE_NAME: &str = "render_pt.rs";

/// The longest source that is looked at, in bytes.
const MAX_SOURCE: u64 = 512 << 10;

/// A hand-in's source.
#[derive(Clone, Debug)]
pub struct Submission {
    /// The path as it was given.
    pub path: PathBuf,
    /// The text of its `render_pt.rs`; what is not UTF-8 in it is replaced by U+FFFD.
    pub source: String,
}

impl Submission {
    /// Reads a hand-in: a `render_pt.rs` under any name, or a folder that has one somewhere.
    pub fn read(path: &Path) -> Result<Self> {
        let file = if path.is_dir() { find(path)? } else { path.to_owned() };
        let size = std::fs::metadata(&file).map_err(|error| Error::file(&file, error))?.len();
        if size > MAX_SOURCE {
            return Err(Error::file(
                &file,
                format!("{size} bytes are too many for a source (at most {MAX_SOURCE})"),
            ));
        }
        let bytes = std::fs::read(&file).map_err(|error| Error::file(&file, error))?;
        // An umlaut in another encoding, most likely within a comment, must not cost all points.
        let source = String::from_utf8_lossy(&bytes).into_owned();
        Ok(Self { path: path.to_owned(), source })
    }

    /// BLAKE3 of the source, in hexadecimal.
    pub fn hash(&self) -> String {
        blake3::hash(self.source.as_bytes()).to_hex().to_string()
    }
}

/// The one `render_pt.rs` below a folder.
fn find(folder: &Path) -> Result<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        let entries = std::fs::read_dir(&folder).map_err(|error| Error::file(&folder, error))?;
        for entry in entries {
            let entry = entry.map_err(|error| Error::file(&folder, error))?;
            let kind = entry.file_type().map_err(|error| Error::file(&entry.path(), error))?;
            // Links are not followed: they lead anywhere.
            if kind.is_dir() && entry.file_name() != "target" && entry.file_name() != ".git" {
                folders.push(entry.path());
            } else if kind.is_file() && entry.file_name() == FILE_NAME {
                found.push(entry.path());
            }
        }
    }
    found.sort();
    match found.as_slice() {
        [file] => Ok(file.clone()),
        [] => Err(Error::file(folder, format!("there is no {FILE_NAME} in this folder"))),
        [first, second, ..] => Err(Error::file(
            folder,
            format!(
                "there are several {FILE_NAME}: {}, {}; name the one to grade",
                first.display(),
                second.display()
            ),
        )),
    }
}
