//! The members of a class: students of the roster with their submissions.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use super::directory::Directory;
use super::find::find;
use super::identity::team_key;
use super::layout::{self, Sent};
use super::roster::{Roster, Student};
use crate::policy::Receipt;
use verdict::error::{Error, Result};

/// One row of the class: a student, a submission, or both.
#[derive(Clone, Debug)]
pub struct Member {
    /// Unique name of the row and of its result folder: the login if there is one.
    pub key: String,
    /// The student; `None` if no table names the submission's student.
    pub student: Option<Student>,
    /// True if the student is on the roster.
    pub on_roster: bool,
    /// Team that handed in together; empty if the student handed in alone.
    pub team: String,
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

    /// True if the student goes by this name, whatever its case.
    pub fn is_called(&self, name: &str) -> bool {
        self.names().iter().any(|own| own.trim().to_lowercase() == name.trim().to_lowercase())
    }
}

/// A class: all students of the roster, then everybody else who handed in.
#[derive(Clone, Debug)]
pub struct Class {
    /// Members in the order of the rows.
    pub members: Vec<Member>,
    /// Keys of all members, also of those that another shard grades.
    pub keys: Vec<String>,
    /// Folder of the submissions.
    pub folder: PathBuf,
}

impl Class {
    /// Finds the submissions in a folder and their students on the roster, which may be empty. `teams` names teams of
    /// students whom the roster gives none.
    ///
    /// # Errors
    /// If there are no submissions, or the name of one contradicts itself.
    pub fn find(folder: &Path, roster: &Roster, teams: &BTreeMap<String, String>) -> Result<Self> {
        let mut students = roster.students.clone();
        for student in students.iter_mut().filter(|student| student.team.is_empty()) {
            let given = student.names().into_iter().find_map(|name| teams.get(&name.to_lowercase()));
            student.team = given.cloned().unwrap_or_default();
        }
        let mut sent_by: Vec<Vec<Sent>> = vec![Vec::new(); students.len()];
        let mut unknown = Vec::new();
        let all_sent = layout::submissions(folder)?;
        let directory = Directory::new(&students);
        let owners_of = |sent: &Sent| owners(&directory, sent);
        let all_owners: Vec<Vec<usize>> = all_sent.iter().map(owners_of).collect::<Result<_>>()?;
        for (sent, owners) in all_sent.into_iter().zip(all_owners) {
            if owners.is_empty() {
                unknown.push(sent);
                continue;
            }
            for &index in &owners {
                sent_by[index].push(sent.clone());
                if sent.identity.team.is_some() && students[index].team.is_empty() {
                    students[index].team.clone_from(&sent.label);
                }
            }
        }
        share_in_teams(&students, &mut sent_by);
        let mut keys = BTreeSet::new();
        let mut members = Vec::new();
        for (student, sent) in students.into_iter().zip(sent_by) {
            let key = student.key();
            members.push(Member { on_roster: true, ..member(Some(student), &key, sent, &mut keys) });
        }
        let others = Directory::new(&roster.others);
        for sent in unknown {
            let other = owners(&others, &sent)?;
            let student = other.first().map(|&index| roster.others[index].clone());
            let key = student.as_ref().map_or_else(|| sent.identity.key(), Student::key);
            members.push(member(student, &key, vec![sent], &mut keys));
        }
        let keys = members.iter().map(|member| member.key.clone()).collect();
        Ok(Self { members, keys, folder: folder.to_owned() })
    }

    /// Adds receipt times. What one member of a team sent, all have sent.
    ///
    /// # Errors
    /// If the manifest names an unknown student or a file that is not there.
    pub fn receive(&mut self, manifest: &crate::policy::Manifest) -> Result<()> {
        let mut unknown: BTreeSet<&str> = manifest.students().collect();
        let mut of_teams: BTreeMap<String, Vec<Receipt>> = BTreeMap::new();
        for member in &mut self.members {
            let names: Vec<String> = member.names().iter().map(|name| name.trim().to_lowercase()).collect();
            for name in &names {
                unknown.remove(name.as_str());
            }
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
            if !member.team.is_empty() {
                of_teams.entry(team_key(&member.team)).or_default().extend(member.receipts.clone());
            }
        }
        for member in &mut self.members {
            if let Some(receipts) = of_teams.get(&team_key(&member.team)).filter(|_| !member.team.is_empty())
            {
                member.receipts.clone_from(receipts);
                member.receipts.dedup();
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

/// Indices of the students who sent something.
fn owners(students: &Directory<'_>, sent: &Sent) -> Result<Vec<usize>> {
    let blame = |message: String| Error::Input(format!("the submission {}: {message}", sent.label));
    let mut owners = find(students, &sent.identity).map_err(blame)?;
    if owners.is_empty() {
        for identity in &sent.inside {
            owners.extend(find(students, identity).map_err(blame)?);
        }
    }
    owners.sort_unstable();
    owners.dedup();
    Ok(owners)
}

/// Gives each member of a team all that its members sent. If that differs, intake asks which of it counts.
fn share_in_teams(students: &[Student], sent_by: &mut [Vec<Sent>]) {
    let mut teams: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    for (index, student) in students.iter().enumerate().filter(|(_, student)| !student.team.is_empty()) {
        teams.entry(team_key(&student.team)).or_default().push(index);
    }
    for members in teams.values() {
        let mut all: Vec<Sent> = members.iter().flat_map(|&index| sent_by[index].clone()).collect();
        all.sort_by(|one, other| one.label.cmp(&other.label));
        all.dedup_by(|one, other| one.label == other.label);
        members.iter().for_each(|&index| sent_by[index].clone_from(&all));
    }
}

fn member(student: Option<Student>, key: &str, sent: Vec<Sent>, keys: &mut BTreeSet<String>) -> Member {
    let own_names = |sent: &Sent| -> Vec<String> {
        let identity = &sent.identity;
        let logins = identity.readings.iter().map(|reading| reading.login.clone());
        let logins: Vec<String> = if student.is_some() { Vec::new() } else { logins.take(1).collect() };
        logins.into_iter().chain(identity.number.clone()).collect()
    };
    Member {
        key: unique(&safe(key), keys),
        on_roster: false,
        team: student.as_ref().map_or_else(String::new, |student| student.team.clone()),
        label: sent.first().map_or_else(String::new, |sent| sent.label.clone()),
        aliases: if sent.len() == 1 { own_names(&sent[0]) } else { Vec::new() },
        paths: sent.into_iter().flat_map(|sent| sent.paths).collect(),
        receipts: Vec::new(),
        student,
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
        let roster = Roster { students: vec![student("ann"), student("bob")], ..Roster::default() };
        let class = Class::find(folder.path(), &roster, &BTreeMap::new()).expect("there are some");
        let rows: Vec<_> = class
            .members
            .iter()
            .map(|member| (member.key.as_str(), member.student.is_some(), member.paths.len()))
            .collect();
        assert_eq!(rows, [("ann", true, 1), ("bob", true, 0), ("zoe", false, 1)]);
    }

    #[test]
    fn a_team_has_one_submission_and_several_rows() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        for name in ["Team 3", "cem", "Team 4/Poe_Dee_dp_304", "Team 4/Fox_Eve_ef_305"] {
            std::fs::create_dir_all(folder.path().join(name)).expect("it can be made");
        }
        let student = |login: &str, team: &str| Student {
            login: login.into(),
            team: team.into(),
            ..Student::default()
        };
        let students = [
            ("ann", "3"),
            ("bob", "Team 3"),
            ("cem", "red"),
            ("dil", "red"),
            ("dp", ""),
            ("ef", ""),
            ("x", ""),
        ];
        let students = students.map(|(login, team)| student(login, team)).to_vec();
        let roster = Roster { students, ..Roster::default() };
        let class = Class::find(folder.path(), &roster, &BTreeMap::new()).expect("there are some");
        let rows: Vec<_> = class
            .members
            .iter()
            .map(|member| (member.key.as_str(), member.label.as_str(), member.team.as_str()))
            .collect();
        assert_eq!(
            rows,
            [
                ("ann", "Team 3", "3"),
                ("bob", "Team 3", "Team 3"),
                ("cem", "cem", "red"),
                ("dil", "cem", "red"),
                ("dp", "Team 4", "Team 4"),
                ("ef", "Team 4", "Team 4"),
                ("x", "", ""),
            ]
        );
    }
}
