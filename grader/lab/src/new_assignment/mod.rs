//! The folder of a new assignment: one task, one check, one mistake. It grades at once.

use std::path::{Path, PathBuf};

use crate::output::{create_folder, failed, write_text};
use harness::workspace::Workspace;
use verdict::error::{Error, Result};
use verdict::rubric::StudentFile;

/// Names and texts of its files. `@NAME@`, `@TITLE@` and `@FILE@` stand for its name, its title and the student's file.
const FILES: [(&str, &str); 8] = [
    ("rubric.yml", include_str!("rubric.yml")),
    ("sheet.md", include_str!("sheet.md")),
    ("handout.md", include_str!("handout.md")),
    ("starter.rs", include_str!("starter.rs.txt")),
    ("solution.rs", include_str!("solution.rs.txt")),
    ("causes.yml", include_str!("causes.yml")),
    ("variants/wrong.yml", include_str!("wrong.yml")),
    ("variants/right.yml", include_str!("right.yml")),
];

/// Writes the folder of a new assignment, and returns its path. `file` is what its students hand in.
///
/// # Errors
/// If the name is not that of a new folder, or the folder cannot be written. Nothing is left behind then.
pub fn create(workspace: &Workspace, name: &str, title: &str, file: &StudentFile) -> Result<PathBuf> {
    let is_plain = |letter: char| letter.is_ascii_lowercase() || letter.is_ascii_digit() || letter == '-';
    if name.is_empty() || name.starts_with('-') || !name.chars().all(is_plain) {
        return Err(Error::Input(format!(
            "`{name}` cannot be the name of an assignment: use lower-case letters, digits and `-`, as in 07-volumes"
        )));
    }
    if title.is_empty() || title.contains(|letter: char| letter.is_control() || ":#'\"{}[]@".contains(letter))
    {
        return Err(Error::Input("the title must be one line without any of : # ' \" { } [ ] @".to_owned()));
    }
    let folder = workspace.assignment(name).path().to_owned();
    if folder.exists() {
        return Err(Error::file(&folder, "exists already: choose another name"));
    }
    let aside = tempfile::Builder::new()
        .prefix(".new-")
        .tempdir_in(workspace.assignments_folder())
        .map_err(|error| failed(&folder, error))?;
    let made = aside.path().join(name);
    for (file_name, text) in FILES {
        let path = made.join(file_name);
        create_folder(path.parent().unwrap_or(&made))?;
        write_text(&path, &filled(text, name, title, file))?;
    }
    std::fs::rename(&made, &folder).map_err(|error| failed(Path::new(name), error))?;
    Ok(folder)
}

fn filled(text: &str, name: &str, title: &str, file: &StudentFile) -> String {
    text.replace("@NAME@", name).replace("@TITLE@", title).replace("@FILE@", &file.path)
}
