//! The roster: students of the class, from one table or several.

use std::path::Path;

use super::names::{Agreement, Name, same};
use crate::table::{Row, Table};
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
    /// Name on GitHub.
    pub github: String,
    /// Numbers in course systems.
    pub identifiers: Vec<String>,
    /// Matriculation number and the like.
    pub numbers: Vec<String>,
    /// The team with which the student hands in.
    pub team: String,
    /// Line in the table, counted from 1.
    pub line: u64,
}

/// Names of the columns that identify a student, in the rosters of common programs.
pub(crate) const LOGIN: &[&str] = &["login", "username", "Benutzername", "Anmeldename", "user", "account"];
pub(crate) const EMAIL: &[&str] = &["email", "Email address", "E-Mail-Adresse", "mail"];
pub(crate) const IDENTIFIER: &[&str] = &["Identifier", "Teilnehmer", "usr_id"];
const NUMBER: &[&str] =
    &["ID number", "Matrikelnummer", "Matriculation number", "Student ID", "number", "ID"];
pub(super) const LAST_NAME: &[&str] = &["Last name", "lastname", "Surname", "Nachname", "Familienname"];
pub(super) const FIRST_NAME: &[&str] = &["First name", "firstname", "Vorname", "Given name"];
pub(super) const FULL_NAME: &[&str] = &["Full name", "Vollständiger Name", "name"];
const GITHUB: &[&str] = &["github_username", "GitHub", "GitHub username"];
const TEAM: &[&str] = &["team", "Mannschaft"];
/// Columns that may hold teams as well as the groups of tutorials.
const GROUP: &[&str] = &["Group", "Gruppe"];

/// Students from all tables that name any.
#[derive(Clone, Debug, Default)]
pub struct Roster {
    /// Students of the first table, with what the other tables add.
    pub students: Vec<Student>,
    /// Students whom only other tables name.
    pub others: Vec<Student>,
}

impl Roster {
    /// Reads a roster from tables. `with_groups`: a column `Group` names teams, not only a column `team`.
    ///
    /// # Errors
    /// If a table cannot be read, has no column that identifies students, or names a student twice.
    pub fn load(tables: &[&Path], with_groups: bool) -> Result<Self> {
        let mut roster = Self::default();
        for (index, path) in tables.iter().enumerate() {
            let students = load(path, with_groups)?;
            if index == 0 {
                roster.students = students;
                continue;
            }
            let name_of = |student: &Student| Name::new(&student.full_name());
            let mut names: Vec<Name> = roster.students.iter().map(name_of).collect();
            for student in students {
                match position(&roster.students, &names, &student) {
                    Some(own) => {
                        roster.students[own].complete(student);
                        names[own] = name_of(&roster.students[own]);
                    }
                    None => roster.others.push(student),
                }
            }
        }
        Ok(roster)
    }
}

/// Reads one table of students: at least one column identifies them.
///
/// # Errors
/// If it cannot be read, has no such column, or names a student twice.
pub fn load(path: &Path, with_groups: bool) -> Result<Vec<Student>> {
    let table = Table::load(path)?;
    let columns = Columns::of(&table, with_groups);
    if !columns.identify() {
        return Err(Error::file(
            path,
            format!(
                "none of its columns tells who a student is (login, email, name, …): {}",
                table.header.join(", ")
            ),
        ));
    }
    let blame = |line: u64, message: String| Error::Input(format!("{}:{line}: {message}", path.display()));
    let mut students: Vec<Student> = Vec::new();
    for row in &table.rows {
        let student = columns.student(row);
        if student.key().is_empty() {
            let columns = "login, e-mail address, number and name are all empty: complete or remove the line";
            return Err(blame(row.line, columns.to_owned()));
        }
        let Some((earlier, what)) = students.iter().find_map(|other| Some((other, other.shared(&student)?)))
        else {
            students.push(student);
            continue;
        };
        if !earlier.has_data_of(&student) {
            return Err(blame(
                student.line,
                format!(
                    "`{what}` is also on line {}, with other data: keep one of the two lines",
                    earlier.line
                ),
            ));
        }
    }
    Ok(students)
}

/// Indices of the columns of a roster.
struct Columns {
    last_name: Option<usize>,
    first_name: Option<usize>,
    login: Option<usize>,
    email: Option<usize>,
    identifier: Option<usize>,
    number: Option<usize>,
    full_name: Option<usize>,
    github: Option<usize>,
    team: Option<usize>,
}

impl Columns {
    fn of(table: &Table, with_groups: bool) -> Self {
        let column = |names: &[&str]| table.column(names);
        Self {
            last_name: column(LAST_NAME),
            first_name: column(FIRST_NAME),
            login: column(LOGIN),
            email: column(EMAIL),
            identifier: column(IDENTIFIER),
            number: column(NUMBER),
            full_name: column(FULL_NAME),
            github: column(GITHUB),
            team: column(TEAM).or_else(|| column(GROUP).filter(|_| with_groups)),
        }
    }

    fn identify(&self) -> bool {
        let names = [self.last_name, self.first_name, self.full_name];
        let others = [self.login, self.email, self.identifier, self.number, self.github];
        names.iter().chain(&others).any(Option::is_some)
    }

    fn student(&self, row: &Row) -> Student {
        let cell = |column: Option<usize>| column.map_or("", |column| row.cell(column)).to_owned();
        let mut student = Student {
            last_name: cell(self.last_name),
            first_name: if self.first_name.is_some() { cell(self.first_name) } else { cell(self.full_name) },
            login: cell(self.login),
            email: cell(self.email),
            github: cell(self.github),
            team: cell(self.team),
            line: row.line,
            ..Student::default()
        };
        for (text, is_identifier) in [(cell(self.identifier), true), (cell(self.number), false)] {
            match participant(&text) {
                Some(number) => student.identifiers.push(number.to_owned()),
                None if text.is_empty() => {}
                None if is_identifier && text.bytes().all(|byte| byte.is_ascii_digit()) => {
                    student.identifiers.push(text);
                }
                // GitHub Classroom's column `identifier` holds what the course chose.
                None if is_identifier && text.contains('@') && student.email.is_empty() => {
                    student.email = text
                }
                None if is_identifier && student.login.is_empty() => student.login = text,
                None => student.numbers.push(text),
            }
        }
        student
    }
}

/// The number in Moodle's "Participant 1234" or "Teilnehmer/in 1234"; `None` for any other text.
pub(crate) fn participant(text: &str) -> Option<&str> {
    let number = text.trim().trim_start_matches(|c: char| !c.is_ascii_digit());
    let word = text.trim().strip_suffix(number)?.trim().to_lowercase();
    let is_moodle = word.starts_with("participant") || word.starts_with("teilnehme");
    (is_moodle && !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit())).then_some(number)
}

impl Student {
    /// All names that the student may have in the course's files.
    pub fn names(&self) -> Vec<&str> {
        let mut names = vec![self.login.as_str(), self.email.as_str(), self.account(), self.github.as_str()];
        names.extend(self.identifiers.iter().chain(&self.numbers).map(String::as_str));
        names.retain(|name| !name.is_empty());
        names
    }

    /// First and last name.
    pub fn full_name(&self) -> String {
        format!("{} {}", self.first_name, self.last_name).trim().to_owned()
    }

    /// Name and line, for messages.
    pub(super) fn describe(&self) -> String {
        let key = self.key();
        let name = self.full_name();
        let name = if name.is_empty() || name == key { key } else { format!("{name} ({key})") };
        format!("{name} on line {} of the roster", self.line)
    }

    /// The e-mail address up to the `@`, which is often the login.
    pub(super) fn account(&self) -> &str {
        self.email.split('@').next().unwrap_or_default()
    }

    /// Name of the student in tables and folders.
    pub(super) fn key(&self) -> String {
        let name = self.full_name();
        let mut names = self.names().into_iter().chain([name.as_str()]).map(str::to_owned);
        names.find(|name| !name.is_empty()).unwrap_or_default()
    }

    /// True if two rows differ in their lines only.
    fn has_data_of(&self, other: &Self) -> bool {
        fn texts(student: &Student) -> [&String; 6] {
            let Student { last_name, first_name, login, email, github, team, .. } = student;
            [last_name, first_name, login, email, github, team]
        }
        texts(self) == texts(other)
            && (&self.identifiers, &self.numbers) == (&other.identifiers, &other.numbers)
    }

    /// What two rows have in common that only one student can have; `None` if nothing.
    fn shared(&self, other: &Self) -> Option<String> {
        let pairs = [(&self.login, &other.login), (&self.email, &other.email), (&self.github, &other.github)];
        let text = pairs.into_iter().find(|(one, other)| same(one, other)).map(|(text, _)| text.clone());
        let common = |own: &[String], others: &[String]| own.iter().find(|it| others.contains(it)).cloned();
        let number = || {
            common(&self.identifiers, &other.identifiers).or_else(|| common(&self.numbers, &other.numbers))
        };
        text.or_else(number).or_else(|| self.has_data_of(other).then(|| self.full_name()))
    }

    /// Adds what another table knows of the same student.
    fn complete(&mut self, other: Self) {
        let has_name = !self.full_name().is_empty();
        let pairs = [
            (&mut self.login, other.login),
            (&mut self.email, other.email),
            (&mut self.github, other.github),
            (&mut self.team, other.team),
        ];
        for (own, new) in pairs {
            if own.is_empty() {
                *own = new;
            }
        }
        if !has_name {
            (self.first_name, self.last_name) = (other.first_name, other.last_name);
        }
        self.identifiers.extend(other.identifiers);
        self.numbers.extend(other.numbers);
        for list in [&mut self.identifiers, &mut self.numbers] {
            list.sort();
            list.dedup();
        }
    }
}

/// The student whom a row of another table means. Names decide only where nobody else has the same.
fn position(students: &[Student], names: &[Name], other: &Student) -> Option<usize> {
    let name = Name::new(&other.full_name());
    let is_namesake = |index: &usize| names[*index].agreement(&name) >= Agreement::Ascii;
    let namesakes: Vec<usize> = (0..students.len()).filter(is_namesake).collect();
    let differs = |own: &str, other: &str| !own.is_empty() && !other.is_empty() && !same(own, other);
    (0..students.len()).find(|&index| {
        let own = &students[index];
        let pairs = [(&own.login, &other.login), (&own.email, &other.email)];
        pairs.iter().any(|(own, other)| same(own, other))
            || (namesakes == [index] && !pairs.iter().any(|(own, other)| differs(own, other)))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tables(texts: &[&str]) -> Result<Roster> {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let paths: Vec<_> =
            (0..texts.len()).map(|index| folder.path().join(format!("{index}.csv"))).collect();
        for (path, text) in paths.iter().zip(texts) {
            std::fs::write(path, text).expect("it can be written");
        }
        Roster::load(&paths.iter().map(std::path::PathBuf::as_path).collect::<Vec<_>>(), false)
    }

    #[test]
    fn a_table_that_names_nobody_is_no_roster() {
        assert!(tables(&["colour\nred\n"]).expect_err("no names").to_string().contains("colour"));
        let message = tables(&["login,name\nal1,Ann\n,\n;,\n"]).expect("an empty line is none");
        assert_eq!(message.students.len(), 2);
        let message = tables(&["login,mark\nal1,1\n,2\n"]).expect_err("a line names nobody").to_string();
        assert!(message.contains(":3:"), "{message}");
    }

    #[test]
    fn a_student_twice_is_one_if_the_rows_are_identical_and_an_error_otherwise() {
        let roster = tables(&["login,name\nal1,Ann Lee\nbr2,Bob Ray\nal1,Ann Lee\n"]).expect("identical");
        assert_eq!(roster.students.len(), 2);
        for twice in [
            "login,name\nal1,Ann Lee\nbr2,Bob Ray\nAL1,Anna Lee\n",
            "login,email\nal1,a@x.org\nbr2,b@x.org\nal2,a@x.org\n",
            "login,Matrikelnummer\nal1,4711\nbr2,4712\nal2,4711\n",
        ] {
            let message = tables(&[twice]).expect_err("they differ").to_string();
            assert!(message.contains(":4:") && message.contains("line 2"), "{message}");
        }
    }

    #[test]
    fn other_tables_add_numbers_to_the_students_of_the_first() {
        let moodle = "Identifier,Full name,Email address\nParticipant 11,Ann Lee,al@x.org\n\
                      Participant 12,Juergen Mueller,jm@x.org\nParticipant 13,Zoe Poe,zp@x.org\n";
        let roster = tables(&["login,name,email\nal1,Ann Lee,al@x.org\njm2,Jürgen Müller,\n", moodle])
            .expect("both are rosters");
        let numbers: Vec<_> = roster.students.iter().map(|student| student.identifiers.join(" ")).collect();
        assert_eq!(numbers, ["11", "12"]);
        assert_eq!(roster.others.len(), 1);
        let github = tables(&["identifier,github_username,name\nal@x.org,octo-cat,Ann\nbr2,bobby,Bob\n"])
            .expect("it is a roster");
        assert_eq!(
            (github.students[0].email.as_str(), github.students[1].login.as_str()),
            ("al@x.org", "br2")
        );
    }
}
