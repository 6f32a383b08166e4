//! The students of a roster, to be looked up by what names them: a class of thousands is found in one pass.

use std::collections::HashMap;

use super::identity::team_key;
use super::names::{Name, fold};
use super::roster::Student;

/// Indices of students by a text, ascending, each once.
#[derive(Debug, Default)]
pub(super) struct Index(HashMap<String, Vec<usize>>);

impl Index {
    /// Adds a text of a student, unless it is empty; to be called in the order of the students.
    pub(super) fn add(&mut self, text: String, student: usize) {
        if !text.is_empty() {
            let students = self.0.entry(text).or_default();
            if students.last() != Some(&student) {
                students.push(student);
            }
        }
    }

    /// The students with this text.
    pub(super) fn of(&self, text: &str) -> &[usize] {
        self.0.get(text).map_or(&[], Vec::as_slice)
    }

    /// The students with one of these texts.
    pub(super) fn of_any(&self, texts: &[String]) -> Vec<usize> {
        let mut found: Vec<usize> = texts.iter().flat_map(|text| self.of(text)).copied().collect();
        found.sort_unstable();
        found.dedup();
        found
    }

    /// The only student with this text.
    fn only(&self, text: &str) -> Option<usize> {
        if let [one] = self.of(text) { Some(*one) } else { None }
    }
}

/// A roster with indices of logins, numbers, names and teams.
#[derive(Debug, Default)]
pub(super) struct Directory<'a> {
    pub(super) students: &'a [Student],
    logins: Index,
    accounts: Index,
    github: Index,
    identifiers: Index,
    numbers: Index,
    any_number: Index,
    names: Index,
    ascii_names: Index,
    team_names: Index,
    teams: Index,
}

/// A text for comparison, as [`super::names::same`] compares.
pub(super) fn key(text: &str) -> String {
    fold(text.trim())
}

impl<'a> Directory<'a> {
    /// Indexes a roster.
    pub(super) fn new(students: &'a [Student]) -> Self {
        let mut directory = Self { students, ..Self::default() };
        students.iter().enumerate().for_each(|(index, student)| directory.add(index, student));
        directory
    }

    fn add(&mut self, index: usize, student: &Student) {
        for login in [&student.login, &student.email, &student.github] {
            self.logins.add(key(login), index);
        }
        self.accounts.add(key(student.account()), index);
        self.github.add(student.github.to_lowercase(), index);
        for (own, numbers) in
            [(&mut self.identifiers, &student.identifiers), (&mut self.numbers, &student.numbers)]
        {
            for number in numbers {
                own.add(key(number), index);
                self.any_number.add(key(number), index);
            }
        }
        let name = student.full_name();
        if !name.is_empty() {
            // Moodle puts the name of the team in front of it.
            for name in [Name::new(&name), Name::new(&format!("{} {name}", student.team))] {
                self.names.add(name.plain(), index);
                name.forms().into_iter().for_each(|form| self.ascii_names.add(form, index));
            }
        }
        if !student.team.is_empty() {
            self.team_names.add(key(&student.team), index);
            self.teams.add(team_key(&student.team), index);
        }
    }

    /// The student with a login, an address or a number.
    pub(super) fn by_login(&self, login: &str) -> Option<usize> {
        let login = key(login);
        [&self.logins, &self.accounts, &self.any_number].into_iter().find_map(|index| index.only(&login))
    }

    /// The student with a number in a course system; where no table has such numbers, any number.
    pub(super) fn by_number(&self, number: &str) -> Option<usize> {
        let has_identifiers = !self.identifiers.0.is_empty();
        if has_identifiers { &self.identifiers } else { &self.numbers }.only(&key(number))
    }

    /// The student with a name: as it is written, or else in ASCII.
    pub(super) fn by_name(&self, name: &str) -> Option<usize> {
        let name = Name::new(name);
        self.names.only(&name.plain()).or_else(|| {
            let found = self.ascii_names.of_any(&name.forms());
            if let [one] = found[..] { Some(one) } else { None }
        })
    }

    /// The students whose names on GitHub a folder of GitHub Classroom, `assignment-login`, ends in.
    pub(super) fn by_github(&self, label: &str) -> Vec<usize> {
        let label = label.to_lowercase();
        let logins: Vec<String> =
            label.match_indices('-').map(|(at, _)| label[at + 1..].to_owned()).collect();
        self.github.of_any(&logins)
    }

    /// The members of a team with this name.
    pub(super) fn named_team(&self, name: &str) -> &[usize] {
        self.team_names.of(&key(name))
    }

    /// The members of a team with this [`team_key`].
    pub(super) fn team(&self, key: &str) -> &[usize] {
        self.teams.of(key)
    }
}
