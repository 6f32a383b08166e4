//! Fills the tables of course systems: the downloaded file with points added, and otherwise unchanged.

use std::path::Path;

use super::comments::Comments;
use super::feedback::{Feedback, ilias_folder, moodle_folder};
use super::gradebook::{Row, State};
use super::roster::{EMAIL, FIRST_NAME, FULL_NAME, IDENTIFIER, LAST_NAME, LOGIN, participant};
use crate::table::{Row as Line, Table};
use verdict::error::{Error, Result};

/// Result of filling a table.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Filled {
    /// Number of rows that were filled in.
    pub filled: usize,
    /// Rows that were left unchanged, with the reason.
    pub left: Vec<String>,
    /// Where the system takes back the feedback of each student who handed something in.
    pub feedback: Vec<Feedback>,
}

const GRADE: &[&str] = &["Grade", "Bewertung"];
const MAXIMUM: &[&str] = &["Maximum Grade", "Bestwertung"];
const FEEDBACK: &[&str] = &["Feedback comments", "Feedback als Kommentar"];
const LOCKED: &[&str] = &["Grade can be changed", "Bewertung kann geändert werden"];

/// Points of a row that are filled in: those who handed in nothing keep what a person may have entered.
fn points(row: &Row) -> Option<f64> {
    row.points.filter(|_| row.state != State::Missing || !row.tasks.is_empty())
}

/// The whole name in a line: of one column, or of two.
fn name_in(line: &Line, [full, first, last]: [Option<usize>; 3]) -> String {
    let cell = |column: Option<usize>| column.map_or("", |column| line.cell(column));
    let name = if full.is_some() { cell(full).to_owned() } else { format!("{} {}", cell(first), cell(last)) };
    name.trim().to_owned()
}

/// Folder of the results that a table is written to.
fn out(to: &Path) -> &Path {
    to.parent().unwrap_or(Path::new("."))
}

/// Fills Moodle's grading worksheet: grade and feedback, by Identifier or e-mail address. A comment that a person has
/// written there stays, and ours follows it.
///
/// # Errors
/// If the file is not such a table, or cannot be read or written.
pub fn fill_moodle(from: &Path, to: &Path, rows: &[Row]) -> Result<Filled> {
    let mut table = Table::load(from)?;
    let grade = table.column(GRADE).ok_or_else(|| Error::file(from, "there is no column `Grade`"))?;
    let (maximum, feedback, changeable) =
        (table.column(MAXIMUM), table.column(FEEDBACK), table.column(LOCKED));
    let (identifier, email) =
        (table.column(IDENTIFIER).or_else(|| table.column(&["ID"])), table.column(EMAIL));
    if identifier.is_none() && email.is_none() {
        return Err(Error::file(from, "there is neither a column `Identifier` nor one of e-mail addresses"));
    }
    let names = [FULL_NAME, FIRST_NAME, LAST_NAME].map(|names| table.column(names));
    let mut filled = Filled::default();
    let mut comments = Comments::open(out(to))?;
    for line in &mut table.rows {
        let Some(row) = find(rows, line, identifier, email) else {
            filled.left.push(format!("line {}: not in the class", line.line));
            continue;
        };
        let number = identifier.and_then(|column| participant(line.cell(column)));
        if let Some(number) = number.filter(|_| row.state != State::Missing) {
            let folder = moodle_folder(&name_in(line, names), number);
            filled.feedback.push(Feedback { key: row.key.clone(), folder });
        }
        let answer = changeable.map_or("", |column| line.cell(column)).to_lowercase();
        if matches!(answer.as_str(), "no" | "nein") {
            filled.left.push(format!("{}: Moodle has locked this grade", row.key));
            continue;
        }
        let Some(points) = points(row) else { continue };
        let comma = maximum.is_some_and(|column| line.cell(column).contains(','));
        let text = points.to_string();
        line.cells[grade] = if comma { text.replace('.', ",") } else { text };
        if let Some(column) = feedback {
            line.cells[column] = comments.combine(&row.key, &line.cells[column], &row.feedback());
        }
        filled.filled += 1;
    }
    comments.save()?;
    table.save(to)?;
    Ok(filled)
}

/// Fills the `status.csv` of an ILIAS exercise: mark and comment, by usr_id or login. ILIAS imports only rows whose
/// `update` is 1.
///
/// # Errors
/// If the file is not such a table, or cannot be read or written.
pub fn fill_ilias(from: &Path, to: &Path, rows: &[Row]) -> Result<Filled> {
    let mut table = Table::load(from)?;
    let column = |name: &str| {
        table.column(&[name]).ok_or_else(|| Error::file(from, format!("there is no column `{name}`")))
    };
    let (update, mark, comment) = (column("update")?, column("mark")?, column("comment")?);
    let (number, login) = (table.column(&["usr_id"]), table.column(LOGIN));
    let names = [LAST_NAME, FIRST_NAME, LOGIN, &["usr_id"]].map(|names| table.column(names));
    let mut filled = Filled::default();
    let mut comments = Comments::open(out(to))?;
    for line in &mut table.rows {
        let Some(row) = find(rows, line, number, login) else {
            filled.left.push(format!("line {}: not in the class", line.line));
            continue;
        };
        let Some(points) = points(row) else { continue };
        let names = names.map(|column| Some(line.cell(column?)));
        if let ([Some(last), Some(first), Some(login), Some(number)], true) =
            (names, row.state != State::Missing)
        {
            let folder = ilias_folder(last, first, login, number);
            filled.feedback.push(Feedback { key: row.key.clone(), folder });
        }
        line.cells[update] = "1".to_owned();
        line.cells[mark] = points.to_string();
        line.cells[comment] = comments.combine(&row.key, &line.cells[comment], &row.feedback());
        filled.filled += 1;
    }
    comments.save()?;
    table.save(to)?;
    Ok(filled)
}

/// Row of the class for a line of the table: by number, or else by login or e-mail address; `None` if no row matches,
/// or several.
fn find<'a>(rows: &'a [Row], line: &Line, number: Option<usize>, name: Option<usize>) -> Option<&'a Row> {
    let number = number.map_or("", |column| line.cell(column));
    let number = participant(number).unwrap_or(number).to_owned();
    let name = name.map_or("", |column| line.cell(column)).to_lowercase();
    let only = |fits: &dyn Fn(&Row) -> bool| {
        let mut found = rows.iter().filter(|row| fits(row));
        found.next().filter(|_| found.next().is_none())
    };
    only(&|row| !number.is_empty() && row.numbers.contains(&number)).or_else(|| {
        let same = |own: &str| !name.is_empty() && own.to_lowercase() == name;
        only(&|row| same(&row.email) || same(&row.login) || same(&row.key))
    })
}
