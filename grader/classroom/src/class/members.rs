//! Roster and submissions brought together.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use super::layout::{self, Sent};
use super::roster::{self, Student};
use crate::policy::Receipt;
use verdict::error::{Error, Result};

/// One row of the class: a student, a submission, or both.
#[derive(Clone, Debug)]
pub struct Member {
    /// What names the row: the login if there is one. It is also the name of the folder with the results.
    pub key: String,
    /// The student of the roster; without one, the submission is somebody else's.
    pub student: Option<Student>,
    /// The name of the submission's folder; empty if there is none.
    pub label: String,
    /// The submission's files and folders; empty if there is none.
    pub paths: Vec<PathBuf>,
    /// When it came.
    pub receipts: Vec<Receipt>,
    /// The names that the submission's folder gives its student.
    aliases: Vec<String>,
}

impl Member {
    /// All that the student may be called in the course's files.
    pub fn names(&self) -> Vec<&str> {
        let mut names: Vec<&str> = self.student.iter().flat_map(Student::names).collect();
        names.extend([self.key.as_str(), self.label.as_str()]);
        names.extend(self.aliases.iter().map(String::as_str));
        names.retain(|name| !name.is_empty());
        names
    }
}

/// A class: everybody of the roster, then everybody else who handed in.
#[derive(Clone, Debug)]
pub struct Class {
    /// The rows.
    pub members: Vec<Member>,
    /// The folder of the submissions.
    pub folder: PathBuf,
}

impl Class {
    /// Looks for submissions in a folder, and gives them to the students of the roster. An empty roster says nothing.
    ///
    /// # Errors
    /// If there are none.
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

    /// Tells the class when its submissions came.
    ///
    /// # Errors
    /// If somebody is named whom nobody knows, or a file that is not there.
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

/// A name that can be that of a folder on every system, and cannot be mistaken for an option or a hidden file.
fn safe(name: &str) -> String {
    let plain = |c: char| if c.is_alphanumeric() || "._-@+".contains(c) { c } else { '_' };
    let text: String = name.trim().chars().take(80).map(plain).collect();
    let text = text.trim_matches(['.', '-', '_', '+', '@']);
    if text.is_empty() { "somebody".to_owned() } else { text.to_owned() }
}

/// The name with a number after it if there is another such folder: some systems know no capitals.
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
