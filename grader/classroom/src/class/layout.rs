//! Finds the submissions in a folder: as packed by Moodle and ILIAS, or one file, folder or archive per student.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::identity::Identity;
use verdict::error::{Error, Result};
use verdict::text::harmless;

/// Files that one student sent.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sent {
    /// Name of the folder, or of the file without its extension.
    pub label: String,
    /// What that name tells about the student.
    pub identity: Identity,
    /// Files and folders.
    pub paths: Vec<PathBuf>,
    /// Members of a team, as far as folders in the team's folder name them.
    pub inside: Vec<Identity>,
}

/// All submissions in a folder, in the order of their names.
///
/// # Errors
/// If it is not a folder, cannot be read, or has no submissions.
pub fn submissions(folder: &Path) -> Result<Vec<Sent>> {
    if !folder.is_dir() {
        return Err(Error::file(folder, "this is no folder; unpack a course system's archive first"));
    }
    let folder = inner_folder(folder)?;
    let mut found: BTreeMap<String, Sent> = BTreeMap::new();
    for path in entries(&folder)? {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let label = label(&name, path.is_dir());
        let identity = Identity::of(&label);
        // The paths keep the name; everything that is written or printed has this one.
        let label = harmless(&label);
        let inside = if identity.team.is_some() { named_inside(&path) } else { Vec::new() };
        // All that Moodle keeps of a student has the same number.
        let key = identity.number.clone().unwrap_or_else(|| match &identity.team {
            Some(team) => format!("team {team}"),
            None => label.clone(),
        });
        let sent = found.entry(key).or_insert(Sent { label, identity, paths: Vec::new(), inside });
        sent.paths.push(path);
    }
    if found.is_empty() {
        return Err(Error::file(&folder, "there are no submissions in this folder"));
    }
    Ok(found.into_values().collect())
}

/// Innermost folder that contains all submissions, since course systems wrap them in folders named after exercise and
/// assignment. Such a folder is only told from a student's by names with a course system's numbers below it.
fn inner_folder(folder: &Path) -> Result<PathBuf> {
    let mut inner = folder.to_owned();
    for _ in 0..4 {
        let below = entries(&inner)?;
        if below.iter().any(|path| identity_of(path).is_of_course_system()) {
            return Ok(inner);
        }
        match below.as_slice() {
            [only] if only.is_dir() => inner.clone_from(only),
            _ => break,
        }
    }
    Ok(folder.to_owned())
}

/// Folders and files that can be part of a submission, sorted. Tables and notes of the staff are skipped.
fn entries(folder: &Path) -> Result<Vec<PathBuf>> {
    let list = std::fs::read_dir(folder).map_err(|error| Error::file(folder, error))?;
    let mut paths = Vec::new();
    for entry in list {
        let path = entry.map_err(|error| Error::file(folder, error))?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
        let of_staff =
            [".csv", ".xlsx", ".xls", ".ods", ".yml", ".json"].iter().any(|end| name.ends_with(end));
        if !name.starts_with('.') && !of_staff {
            paths.push(path);
        }
    }
    paths.sort();
    Ok(paths)
}

/// Name of a file without its extension.
fn label(name: &str, is_folder: bool) -> String {
    if is_folder {
        return name.to_owned();
    }
    let lower = name.to_lowercase();
    for end in [".tar.gz", ".tgz", ".tar", ".zip", ".rs", ".txt", ".md", ".pdf", ".7z", ".rar"] {
        if lower.ends_with(end) && name.is_char_boundary(name.len() - end.len()) && name.len() > end.len() {
            return name[..name.len() - end.len()].to_owned();
        }
    }
    name.to_owned()
}

fn identity_of(path: &Path) -> Identity {
    Identity::of(&path.file_name().unwrap_or_default().to_string_lossy())
}

/// Students whom folders in the folder of a team name, as ILIAS does.
fn named_inside(folder: &Path) -> Vec<Identity> {
    let below = if folder.is_dir() { entries(folder).unwrap_or_default() } else { Vec::new() };
    let named = below.iter().filter(|path| path.is_dir()).map(|path| identity_of(path));
    named.filter(|identity| identity.number.is_some()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(files: &[&str]) -> Vec<(String, usize)> {
        let folder = tempfile::tempdir().expect("a temporary folder");
        for file in files {
            let path = folder.path().join(file);
            std::fs::create_dir_all(path.parent().expect("it has one")).expect("it can be made");
            std::fs::write(path, "").expect("it can be written");
        }
        let sent = submissions(folder.path()).expect("there are some");
        sent.into_iter().map(|sent| (sent.identity.number.unwrap_or(sent.label), sent.paths.len())).collect()
    }

    fn expect(files: &[&str], expected: &[(&str, usize)]) {
        let expected: Vec<_> = expected.iter().map(|&(name, count)| (name.to_owned(), count)).collect();
        assert_eq!(labels(files), expected, "{files:?}");
    }

    #[test]
    fn the_layouts_of_course_systems_are_recognised() {
        // Moodle, in folders.
        expect(
            &[
                "Ann Lee_11_assignsubmission_file_/render_pt.rs",
                "Ann Lee_11_assignsubmission_onlinetext_/onlinetext.html",
                "Bob_Ray Öz_12_assignsubmission_file/x.zip",
                "grades.csv",
            ],
            &[("11", 2), ("12", 1)],
        );
        // Moodle, without.
        expect(
            &["Ann Lee_11_assignsubmission_file_render_pt.rs", "Ann Lee_11_assignsubmission_file_5.2a.pdf"],
            &[("11", 2)],
        );
        // ILIAS.
        let ilias = ["Ex/Sheet 5/Lee_Ann_al1_301/render_pt.rs", "Ex/Sheet 5/de_la_Cruz_Bo_bc2_302/a.zip"];
        expect(&ilias, &[("301", 1), ("302", 1)]);
        // Teams.
        expect(
            &["Group_123457_assignsubmission_file_/render_pt.rs", "Ann Lee_11_assignsubmission_file_/x.rs"],
            &[("11", 1), ("Group_123457_assignsubmission_file_", 1)],
        );
        expect(
            &["Ex/Sheet 5/Team 3/render_pt.rs", "Ex/Sheet 5/Team 4/a.zip"],
            &[("Team 3", 1), ("Team 4", 1)],
        );
        // One of each for each student.
        expect(
            &["ann/src/render_pt.rs", "bob.zip", "cem.rs", "cem.pdf"],
            &[("ann", 1), ("bob", 1), ("cem", 2)],
        );
        expect(&["ann/src/render_pt.rs"], &[("ann", 1)]);
        expect(&["ann/src/render_pt.rs", "ann/doc/a.txt"], &[("ann", 1)]);
    }
}
