//! A table of marks, as `grader mark --from` reads it.

use std::path::Path;

use classroom::table::{Table, number};
use verdict::error::{Error, Result};
use verdict::rubric::Rubric;

/// One mark to record.
pub(super) struct Entry {
    /// Where it comes from, for messages; empty for the command line.
    pub(super) at: String,
    pub(super) student: String,
    pub(super) task: String,
    pub(super) points: f64,
    pub(super) comment: String,
}

/// Reads a table: a row for each mark (`student`, `task`, `points`, `comment`), or a row for each student with a column
/// for each task that tutors mark. Cells without points are skipped.
///
/// # Errors
/// The first wrong cell, with file, line and column.
pub(super) fn entries(path: &Path, rubric: &Rubric) -> Result<Vec<Entry>> {
    let table = Table::load(path)?;
    let student = table
        .column(&["student", "login", "email"])
        .ok_or_else(|| Error::file(path, "there is no column `student`"))?;
    let comment = table.column(&["comment", "Kommentar"]);
    let long = table.column(&["task"]).zip(table.column(&["points", "Punkte"]));
    let of_tasks: Vec<(usize, &str)> = rubric
        .tasks
        .iter()
        .filter(|task| task.manual)
        .filter_map(|task| Some((table.column(&[&task.id])?, task.id.as_str())))
        .collect();
    if long.is_none() && of_tasks.is_empty() {
        return Err(Error::file(
            path,
            "there are neither the columns `task` and `points` nor one named after a task",
        ));
    }
    let mut entries = Vec::new();
    for row in &table.rows {
        let cells = match long {
            Some((task, points)) => vec![(points, row.cell(task))],
            None => of_tasks.clone(),
        };
        for (column, task) in cells.into_iter().filter(|(column, _)| !row.cell(*column).is_empty()) {
            let at = format!("{}:{}: ", path.display(), row.line);
            let (name, text) = (&table.header[column], row.cell(column));
            let points = number(text).ok_or_else(|| {
                Error::Input(format!("{at}column `{name}`: `{text}` is no number: write 7.5 or 7,5"))
            })?;
            let comment = comment.map_or("", |comment| row.cell(comment)).to_owned();
            entries.push(Entry {
                at,
                student: row.cell(student).to_owned(),
                task: task.to_owned(),
                points,
                comment,
            });
        }
    }
    Ok(entries)
}
