//! Comments in the tables of course systems: those of people are kept, ours are replaced.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::table::no_formula;
use verdict::error::{Error, Result};
use verdict::output;

/// The comments that earlier runs have written. A comment that is not among them is a person's.
#[derive(Debug)]
pub(super) struct Comments {
    path: PathBuf,
    /// Text of a person that was there before, by the BLAKE3 of row and comment.
    written: BTreeMap<String, String>,
}

#[derive(Serialize, Deserialize)]
struct CommentsFile {
    schema: String,
    written: BTreeMap<String, String>,
}

/// Version of the format of `comments.json`.
const SCHEMA: &str = "arty-comments/1";

impl Comments {
    /// Reads those of a result folder.
    ///
    /// # Errors
    /// If its `comments.json` is there and not valid.
    pub(super) fn open(out: &Path) -> Result<Self> {
        let path = out.join("comments.json");
        let written = match std::fs::read(&path) {
            Ok(bytes) => {
                let file: CommentsFile =
                    serde_json::from_slice(&bytes).map_err(|error| Error::file(&path, error))?;
                file.written
            }
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => BTreeMap::new(),
            Err(error) => return Err(Error::file(&path, error)),
        };
        Ok(Self { path, written })
    }

    /// Saves them. To be called before the table is written: a comment that is unknown later would be a person's.
    ///
    /// # Errors
    /// If they cannot be written.
    pub(super) fn save(&self) -> Result<()> {
        let file = CommentsFile { schema: SCHEMA.to_owned(), written: self.written.clone() };
        output::write_json(&self.path, &file)
    }

    /// The comment for a row whose table has `present`: what a person wrote, then `ours`.
    pub(super) fn combine(&mut self, row: &str, present: &str, ours: &str) -> String {
        let earlier = self.written.get(&hash(row, present)).cloned();
        let person = earlier.unwrap_or_else(|| present.trim().to_owned());
        let combined = match (person.is_empty(), ours.is_empty()) {
            (true, _) => no_formula(ours),
            (false, true) => person.clone(),
            (false, false) => format!("{person}\n\n{ours}"),
        };
        self.written.insert(hash(row, &combined), person);
        combined
    }
}

/// Hash of a comment and its row. Course systems add tags and other blanks on the way.
fn hash(row: &str, comment: &str) -> String {
    let mut is_tag = false;
    let mut plain = String::new();
    for c in comment.chars() {
        match c {
            '<' => is_tag = true,
            '>' if is_tag => is_tag = false,
            _ if is_tag || c.is_whitespace() => {}
            _ => plain.push(c),
        }
    }
    let plain =
        [("&nbsp;", ""), ("&lt;", "<"), ("&gt;", ">"), ("&quot;", "\""), ("&#039;", "'"), ("&amp;", "&")]
            .iter()
            .fold(plain, |text, (from, to)| text.replace(from, to));
    blake3::hash(format!("{row}\n{plain}").as_bytes()).to_hex().to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_comment_of_a_person_stays_and_ours_is_replaced() {
        let out = tempfile::tempdir().expect("a temporary folder");
        let mut comments = Comments::open(out.path()).expect("there are none");
        assert_eq!(comments.combine("ann", "", "1: 8"), "1: 8");
        assert_eq!(comments.combine("bob", "See me", "1: 8"), "See me\n\n1: 8");
        comments.save().expect("it can be written");
        let mut comments = Comments::open(out.path()).expect("they are whole");
        // The worksheet comes back with what was uploaded.
        assert_eq!(comments.combine("ann", "<p>1: 8</p>", "1: 10"), "1: 10");
        assert_eq!(comments.combine("bob", "<p>See me</p>\n<p>1:&nbsp;8</p>", "1: 10"), "See me\n\n1: 10");
        assert_eq!(
            comments.combine("cem", "1: 8", "1: 10"),
            "1: 8\n\n1: 10",
            "it was never written to this row"
        );
        assert_eq!(comments.combine("dee", "", "=1"), "'=1");
    }
}
