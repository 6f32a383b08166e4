//! The members of a class: students of the roster with their submissions.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use super::layout::{self, Sent};
use super::roster::{self, Student};
use crate::policy::Receipt;
use verdict::error::{Error, Result};

/// One row of the class: a student, a submission, or both.
#[derive(Clone, Debug)]
pub struct Member {
    /// Unique name of the row and of its result folder: the login if there is one.
    pub key: String,
    /// Student of the roster; `None` if the submission is of somebody else.
    pub student: Option<Student>,
    /// Name of the submission's folder or file; empty if there is none.
    pub label: String,
    /// Files and folders of the submission; empty if there is none.
    pub paths: Vec<PathBuf>,
    /// Receipts, in the order of the manifest.
    pub receipts: Vec<Receipt>,
    /// Names of the student in the name of the submission's folder.
    aliases: Vec<String>,
}

impl Member {
    /// All names that the student may have in the course's files.
    pub fn names(&self) -> Vec<&str> {
        let mut names: Vec<&str> = self.student.iter().flat_map(Student::names).collect();
        names.extend([self.key.as_str(), self.label.as_str()]);
        names.extend(self.aliases.iter().map(String::as_str));
        names.retain(|name| !name.is_empty());
        names
    }
}

/// A class: all students of the roster, then everybody else who handed in.
#[derive(Clone, Debug)]
pub struct Class {
    /// Members in the order of the rows.
    pub members: Vec<Member>,
    /// Folder of the submissions.
    pub folder: PathBuf,
}

impl Class {
    /// Finds the submissions in a folder and their students on the roster, which may be empty.
    ///
    /// # Errors
    /// If there are no submissions.
    pub fn find(folder: &Path, roster: &[Student]) -> Result<Self> {
        let mut sent_by: Vec<Vec<Sent>> = vec![Vec::new(); roster.len()];
        let mut unknown = Vec::new();
        for sent in layout::submissions(folder)? {
            match roster::find(roster, &sent.identity) {
                Some(index) => sent_by[index].push(sent),
                None => unknown.push(sent),
            }
        }
        let mut keys = BTreeSet::new();
        let mut members = Vec::new();
        for (student, sent) in roster.iter().zip(sent_by) {
            members.push(member(Some(student.clone()), &student.key(), sent, &mut keys));
        }
        for sent in unknown {
            let identity = &sent.identity;
            let key = identity.login.clone().or_else(|| identity.full_name.clone()).unwrap_or_default();
            members.push(member(None, &key, vec![sent], &mut keys));
        }
        Ok(Self { members, folder: folder.to_owned() })
    }

    /// Adds receipt times.
    ///
    /// # Errors
    /// If the manifest names an unknown student or a file that is not there.
    pub fn receive(&mut self, manifest: &crate::policy::Manifest) -> Result<()> {
        let mut unknown: BTreeSet<&str> = manifest.students().collect();
        for member in &mut self.members {
            let names: Vec<String> = member.names().iter().map(|name| name.trim().to_lowercase()).collect();
            unknown.retain(|student| !names.iter().any(|name| name == student));
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            member.receipts = manifest.of(&names).to_vec();
            for receipt in member.receipts.iter().filter(|receipt| !receipt.path.is_empty()) {
                let path = Path::new(&receipt.path);
                let inside = path.components().all(|part| matches!(part, std::path::Component::Normal(_)));
                if !inside || !self.folder.join(path).exists() {
                    return Err(Error::Input(format!(
                        "the manifest names {}, which is not in the folder of the class",
                        receipt.path
                    )));
                }
            }
        }
        match unknown.first() {
            Some(student) => Err(Error::Input(format!(
                "the manifest names `{student}`, who is neither on the roster nor has handed in"
            ))),
            None => Ok(()),
        }
    }
}

fn member(student: Option<Student>, key: &str, sent: Vec<Sent>, keys: &mut BTreeSet<String>) -> Member {
    let aliases = sent.iter().flat_map(|sent| [sent.identity.login.clone(), sent.identity.number.clone()]);
    Member {
        key: unique(&safe(key), keys),
        student,
        label: sent.first().map_or_else(String::new, |sent| sent.label.clone()),
        aliases: aliases.flatten().collect(),
        paths: sent.into_iter().flat_map(|sent| sent.paths).collect(),
        receipts: Vec::new(),
    }
}

/// Makes a name that is valid for a folder on every system, and is neither an option nor hidden.
fn safe(name: &str) -> String {
    let plain = |c: char| if c.is_alphanumeric() || "._-@+".contains(c) { c } else { '_' };
    let text: String = name.trim().chars().take(80).map(plain).collect();
    let text = text.trim_matches(['.', '-', '_', '+', '@']);
    match text {
        "" => "somebody".to_owned(),
        reserved if is_reserved(reserved) => format!("{reserved}_"),
        text => text.to_owned(),
    }
}

/// True for names that Windows keeps for devices, whatever their extension.
fn is_reserved(name: &str) -> bool {
    let stem = name.split('.').next().unwrap_or_default().trim_end().to_lowercase();
    let is_numbered = |kind| {
        stem.strip_prefix(kind)
            .is_some_and(|number| number.chars().count() == 1 && number.chars().all(char::is_numeric))
    };
    matches!(stem.as_str(), "con" | "prn" | "aux" | "nul" | "conin$" | "conout$")
        || is_numbered("com")
        || is_numbered("lpt")
}

/// Adds a number to a name if it is taken, ignoring case as some file systems do.
fn unique(name: &str, keys: &mut BTreeSet<String>) -> String {
    let mut candidate = name.to_owned();
    let mut number = 2;
    while !keys.insert(candidate.to_lowercase()) {
        candidate = format!("{name}~{number}");
        number += 1;
    }
    candidate
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_folders_anywhere_and_no_two_are_the_same() {
        let mut keys = BTreeSet::new();
        for (name, expected) in [
            ("ab12", "ab12"),
            ("AB12", "AB12~2"),
            ("../../etc/passwd", "etc_passwd"),
            ("=cmd|' /C calc'!A0", "cmd____C_calc__A0"),
            ("Jürgen Ö", "Jürgen_Ö"),
            ("CON", "CON_"),
            ("aux.txt", "aux.txt_"),
            ("Com1", "Com1_"),
            ("console", "console"),
            ("a\u{1b}[2J\u{202e}b", "a__2J_b"),
            ("🎨", "somebody"),
            ("", "somebody~2"),
        ] {
            assert_eq!(unique(&safe(name), &mut keys), expected);
        }
    }

    #[test]
    fn everybody_of_the_roster_has_a_row_and_so_has_everybody_else_who_handed_in() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        for name in ["ann", "zoe"] {
            std::fs::create_dir(folder.path().join(name)).expect("it can be made");
        }
        let student = |login: &str| Student { login: login.into(), ..Student::default() };
        let class = Class::find(folder.path(), &[student("ann"), student("bob")]).expect("there are some");
        let rows: Vec<_> = class
            .members
            .iter()
            .map(|member| (member.key.as_str(), member.student.is_some(), member.paths.len()))
            .collect();
        assert_eq!(rows, [("ann", true, 1), ("bob", true, 0), ("zoe", false, 1)]);
    }
}
