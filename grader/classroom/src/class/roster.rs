//! The roster: students of the class.

use std::path::Path;

use unicode_normalization::UnicodeNormalization;

use super::layout::Identity;
use crate::table::Table;
use verdict::error::{Error, Result};

/// A student of the roster. Unknown fields are empty.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Student {
    /// Family name.
    pub last_name: String,
    /// Given name, or the whole name if the roster does not separate them.
    pub first_name: String,
    /// Login.
    pub login: String,
    /// E-mail address.
    pub email: String,
    /// Numbers in course systems, and the matriculation number.
    pub numbers: Vec<String>,
}

/// Names of the columns that identify a student, in the rosters of common programs.
pub(super) const LOGIN: &[&str] = &["login", "username", "Benutzername", "Anmeldename", "user", "account"];
pub(super) const EMAIL: &[&str] = &["email", "Email address", "E-Mail-Adresse", "mail"];
pub(super) const IDENTIFIER: &[&str] = &["Identifier", "Teilnehmer", "usr_id"];
const NUMBER: &[&str] =
    &["ID number", "Matrikelnummer", "Matriculation number", "Student ID", "number", "ID"];
const LAST_NAME: &[&str] = &["Last name", "lastname", "Surname", "Nachname", "Familienname"];
const FIRST_NAME: &[&str] = &["First name", "firstname", "Vorname", "Given name"];
const FULL_NAME: &[&str] = &["Full name", "Vollständiger Name", "name"];

/// Reads a roster: a table with at least one column that identifies students.
///
/// # Errors
/// If it cannot be read or has no such column.
pub fn load(path: &Path) -> Result<Vec<Student>> {
    let table = Table::load(path)?;
    let columns =
        [LAST_NAME, FIRST_NAME, LOGIN, EMAIL, IDENTIFIER, NUMBER, FULL_NAME].map(|names| table.column(names));
    if columns.iter().all(Option::is_none) {
        return Err(Error::file(
            path,
            format!(
                "none of its columns tells who a student is (login, email, name, …): {}",
                table.header.join(", ")
            ),
        ));
    }
    let [last_name, first_name, login, email, identifier, number, full_name] = columns;
    let students = table.rows.iter().map(|row| {
        let cell = |column: Option<usize>| column.map_or("", |column| row.cell(column)).to_owned();
        let first_name = if first_name.is_some() { cell(first_name) } else { cell(full_name) };
        let numbers = [digits(&cell(identifier)), cell(number), digits(&cell(number))];
        let mut student = Student {
            last_name: cell(last_name),
            first_name,
            login: cell(login),
            email: cell(email),
            numbers: numbers.into_iter().filter(|number| !number.is_empty()).collect(),
        };
        student.numbers.dedup();
        student
    });
    Ok(students.collect())
}

/// The number in "Participant 1234".
pub(super) fn digits(text: &str) -> String {
    text.chars().filter(char::is_ascii_digit).collect()
}

impl Student {
    /// All names that the student may have in the course's files.
    pub fn names(&self) -> Vec<&str> {
        let mut names = vec![self.login.as_str(), self.email.as_str(), self.account()];
        names.extend(self.numbers.iter().map(String::as_str));
        names.retain(|name| !name.is_empty());
        names
    }

    /// The e-mail address up to the `@`, which is often the login.
    fn account(&self) -> &str {
        self.email.split('@').next().unwrap_or_default()
    }

    /// Name of the student in tables and folders.
    pub(super) fn key(&self) -> String {
        let name = format!("{} {}", self.first_name, self.last_name);
        let mut names = self.names().into_iter().chain([name.trim()]).map(str::to_owned);
        names.find(|name| !name.is_empty()).unwrap_or_default()
    }
}

/// Index of the student with an identity: compares number, login, then name. `None` if no student matches, or several.
pub fn find(roster: &[Student], identity: &Identity) -> Option<usize> {
    let same = |one: &str, other: &str| !one.is_empty() && fold(one) == fold(other);
    let only = |fits: &dyn Fn(&Student) -> bool| {
        let mut found =
            roster.iter().enumerate().filter(|(_, student)| fits(student)).map(|(index, _)| index);
        found.next().filter(|_| found.next().is_none())
    };
    let number = identity.number.as_deref().unwrap_or_default();
    let login = identity.login.as_deref().unwrap_or_default();
    let name = words(identity.full_name.as_deref().unwrap_or_default());
    only(&|student| student.numbers.iter().any(|own| same(own, number)))
        .or_else(|| only(&|student| same(&student.login, login) || same(&student.email, login)))
        .or_else(|| only(&|student| same(student.account(), login)))
        .or_else(|| only(&|student| student.numbers.iter().any(|own| same(own, login))))
        .or_else(|| {
            let of = |student: &Student| words(&format!("{} {}", student.first_name, student.last_name));
            only(&|student| !name.is_empty() && of(student) == name)
        })
}

/// A name for comparison: composed (NFKC), in lower case.
fn fold(text: &str) -> String {
    text.nfkc().flat_map(char::to_lowercase).collect()
}

/// The words of a name, sorted, since some systems put the family name first.
fn words(name: &str) -> Vec<String> {
    let folded = fold(name);
    let mut words: Vec<String> = folded
        .split(|c: char| !c.is_alphanumeric())
        .filter(|word| !word.is_empty())
        .map(str::to_owned)
        .collect();
    words.sort();
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    fn roster(text: &str) -> Vec<Student> {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("roster.csv");
        std::fs::write(&path, text).expect("it can be written");
        load(&path).expect("it is a roster")
    }

    fn by_name(name: &str) -> Identity {
        Identity { full_name: Some(name.into()), ..Identity::default() }
    }

    #[test]
    fn students_are_found_by_number_login_address_and_name() {
        let moodle = roster(
            "Identifier,Full name,Email address\nParticipant 11,Ann Lee,al@x.org\nParticipant 12,J\u{fc}rgen O'Neill,jo@x.org\n",
        );
        assert_eq!(find(&moodle, &Identity { number: Some("12".into()), ..Identity::default() }), Some(1));
        assert_eq!(find(&moodle, &Identity { login: Some("AL".into()), ..Identity::default() }), Some(0));
        // Decomposed, as macOS writes file names, and with the family name first.
        assert_eq!(find(&moodle, &by_name("O_Neill Ju\u{308}rgen")), Some(1));
        assert_eq!(find(&moodle, &by_name("Nobody")), None);
        let german =
            roster("Nachname;Vorname;Benutzername;Matrikelnummer\nLee;Ann;al1;4711\nLee;Ann;al2;4712\n");
        assert_eq!(find(&german, &by_name("Lee Ann")), None, "there are two");
        assert_eq!(find(&german, &Identity { login: Some("4712".into()), ..Identity::default() }), Some(1));
    }

    #[test]
    fn a_table_that_names_nobody_is_no_roster() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("roster.csv");
        std::fs::write(&path, "colour\nred\n").expect("it can be written");
        assert!(load(&path).expect_err("no names").to_string().contains("colour"));
    }
}
