//! The rows of a class, as a table (`gradebook.csv`) and as data (`class.json`).

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::Member;
use super::record::Record;
use super::similar::Group;
use crate::marks::{Marks, fingerprint};
use crate::policy::{Lateness, Receipt, Rules, Standing, points_after};
use crate::table::{Table, no_formula};
use verdict::error::{Error, Result};
use verdict::output;
use verdict::report::Provenance;
use verdict::rubric::Rubric;
use verdict::submission::IntakeFinding;

/// Version of the format of `class.json`.
const SCHEMA: &str = "arty-class/2";

/// Where the points of a row come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum State {
    /// The submission was graded; it may not have compiled.
    Graded,
    /// The submission could not be taken in.
    Refused,
    /// Nothing was handed in.
    Missing,
    /// The grader or the machine failed, and there is no earlier result.
    Harness,
}

/// One student or submission.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Unique name of the student and of the folder in `submissions/`.
    pub key: String,
    /// Family name.
    pub last_name: String,
    /// Given name.
    pub first_name: String,
    /// Login.
    pub login: String,
    /// E-mail address.
    pub email: String,
    /// Numbers in course systems.
    pub numbers: Vec<String>,
    /// False if the student is not on the roster.
    pub on_roster: bool,
    /// Name of the submission's folder or file.
    pub sent: String,
    /// Graded, refused, missing, or failed by the grader.
    pub state: State,
    /// Main reason why points are missing.
    pub reason: Option<IntakeFinding>,
    /// Notes of intake.
    pub notes: Vec<IntakeFinding>,
    /// Raw points of each task.
    pub tasks: BTreeMap<String, Option<f64>>,
    /// Sum of raw points.
    pub raw: Option<f64>,
    /// Receipt time.
    pub received_at: Option<String>,
    /// Lateness; none without a late policy.
    pub lateness: Option<Lateness>,
    /// Points that count, for tasks that are graded automatically or have been marked.
    pub points: Option<f64>,
    /// Written explanations, by name.
    pub explanations: Vec<String>,
    /// [`crate::marks::fingerprint`] of the explanations; empty if there are none.
    pub explanation: String,
    /// Tutors' comments, by task.
    pub comments: BTreeMap<String, String>,
    /// Team that handed in together; empty if the student handed in alone.
    pub team: String,
    /// Time of grading.
    pub graded_at: Option<String>,
    /// BLAKE3 of the source.
    pub source: String,
    /// True if the points are of an earlier run because the grader failed in this one.
    pub kept: bool,
}

impl Row {
    fn new(member: &Member, state: State) -> Self {
        let student = member.student.clone().unwrap_or_default();
        Self {
            key: member.key.clone(),
            last_name: student.last_name,
            first_name: student.first_name,
            login: student.login,
            email: student.email,
            numbers: student.identifiers.into_iter().chain(student.numbers).collect(),
            on_roster: member.on_roster,
            sent: member.label.clone(),
            state,
            reason: None,
            notes: Vec::new(),
            tasks: BTreeMap::new(),
            raw: None,
            received_at: None,
            lateness: None,
            points: None,
            explanations: Vec::new(),
            explanation: String::new(),
            comments: BTreeMap::new(),
            team: member.team.clone(),
            graded_at: None,
            source: String::new(),
            kept: false,
        }
    }

    /// Row of a student who handed in nothing.
    pub(super) fn missing(member: &Member) -> Self {
        let reason =
            IntakeFinding { code: "missing".to_owned(), message: "nothing was handed in".to_owned() };
        Self { reason: Some(reason), raw: Some(0.0), points: Some(0.0), ..Self::new(member, State::Missing) }
    }

    /// Row of a submission that the grader failed with.
    pub(super) fn harness(member: &Member, reason: IntakeFinding) -> Self {
        Self { reason: Some(reason), ..Self::new(member, State::Harness) }
    }

    /// Row of a submission that was taken in, without marks and penalty.
    pub(super) fn of_record(
        member: &Member,
        record: &Record,
        lateness: Option<Lateness>,
        receipt: Option<&Receipt>,
    ) -> Self {
        let refused = record.report.is_empty();
        let mut reason = record.reason.clone();
        if let Some(late) = lateness.as_ref().filter(|lateness| lateness.standing == Standing::NotAccepted) {
            let message = format!("not accepted: {} late", late.late_by_text());
            reason = Some(IntakeFinding { code: "late".to_owned(), message });
        }
        Self {
            reason,
            notes: record.notes.clone(),
            tasks: record.tasks.clone(),
            raw: Some(record.earned),
            received_at: receipt.and_then(|receipt| receipt.received_at).map(|time| time.to_string()),
            lateness,
            points: Some(record.earned),
            explanations: record.explanations.iter().map(|explanation| explanation.name.clone()).collect(),
            explanation: fingerprint(&record.explanations),
            graded_at: Some(record.graded_at.clone()),
            source: record.source.clone(),
            ..Self::new(member, if refused { State::Refused } else { State::Graded })
        }
    }

    /// Adds the marks of the student and the penalty for being late, to a row that has neither.
    pub(super) fn apply(&mut self, marks: &Marks, rules: Option<&Rules>) {
        for mark in marks.of(&self.key, &self.explanation) {
            self.raw = Some(self.raw.unwrap_or(0.0) + mark.points);
            self.tasks.insert(mark.task.clone(), Some(mark.points));
            if !mark.comment.is_empty() {
                self.comments.insert(mark.task.clone(), mark.comment.clone());
            }
        }
        for mark in marks.outdated(&self.key, &self.explanation) {
            let message = format!("the explanation has changed since task {} was marked", mark.task);
            self.notes.push(IntakeFinding { code: "mark-again".to_owned(), message });
        }
        self.points = match (rules, &self.lateness, self.raw) {
            (Some(rules), Some(lateness), Some(raw)) => Some(points_after(rules, raw, lateness)),
            (_, _, raw) => raw,
        };
    }

    /// Tasks that a tutor has still to mark: those without points if an explanation was handed in.
    pub fn unmarked<'a>(&'a self, rubric: &'a Rubric) -> impl Iterator<Item = &'a str> {
        let has_points = |task: &str| self.tasks.get(task).copied().flatten().is_some();
        let manual = rubric.tasks.iter().filter(|task| task.manual).map(|task| task.id.as_str());
        manual.filter(move |task| !self.explanations.is_empty() && !has_points(task))
    }

    /// First and last name; empty if unknown.
    pub fn name(&self) -> String {
        format!("{} {}", self.first_name, self.last_name).trim().to_owned()
    }

    /// One line for the terminal.
    pub(super) fn line(&self) -> String {
        let points = self.points.map_or_else(|| "–".to_owned(), |points| points.to_string());
        let reason = self.reason.as_ref().map_or("", |reason| reason.code.as_str());
        let kept = if self.kept { " (earlier result kept)" } else { "" };
        format!("{:<24} {points:>5}  {reason}{kept}", verdict::text::harmless(&self.key))
    }

    /// Feedback for the student in a course system: points by task, and why some are missing.
    pub(super) fn feedback(&self) -> String {
        let mut parts: Vec<String> = self
            .tasks
            .iter()
            .filter_map(|(task, points)| {
                let comment = self.comments.get(task).map_or_else(String::new, |text| format!(" ({text})"));
                points.map(|points| format!("{task}: {points}{comment}"))
            })
            .collect();
        if let Some(lateness) = self.lateness.as_ref().filter(|lateness| lateness.standing == Standing::Late)
        {
            parts.push(format!("{} late: × {}", lateness.late_by_text(), lateness.factor));
        }
        parts.extend(self.reason.as_ref().map(|reason| format!("{}: {}", reason.code, reason.message)));
        parts.join("; ")
    }
}

/// Writes `gradebook.csv`. Texts that a spreadsheet would take for formulas get a leading `'`.
///
/// # Errors
/// If it cannot be written.
pub fn save_gradebook(path: &Path, rows: &[&Row], tasks: &[String]) -> Result<()> {
    let names = |list: &[&str]| list.iter().map(|&name| name.to_owned()).collect::<Vec<String>>();
    let mut header =
        names(&["student", "last_name", "first_name", "login", "email", "number", "team", "state", "reason"]);
    header.extend(tasks.iter().cloned());
    header.extend(names(&[
        "raw",
        "received_at",
        "late_by",
        "factor",
        "points",
        "lateness",
        "notes",
        "explanation",
        "sent",
        "on_roster",
        "graded_at",
    ]));
    let mut table = Table::new(header);
    for row in rows {
        let number = |number: Option<f64>| number.map_or_else(String::new, |number| number.to_string());
        let late = row.lateness.as_ref();
        let codes: Vec<&str> = row.notes.iter().map(|note| note.code.as_str()).collect();
        let text = |text: &str| no_formula(text);
        let standing = late.map_or_else(String::new, |lateness| {
            let word = serde_json::to_value(lateness.standing).ok();
            let word = word.as_ref().and_then(|word| word.as_str()).unwrap_or_default().to_owned();
            if lateness.why.is_empty() { word } else { format!("{word} ({})", lateness.why) }
        });
        let mut cells = vec![
            text(&row.key),
            text(&row.last_name),
            text(&row.first_name),
            text(&row.login),
            text(&row.email),
            text(&row.numbers.join(" ")),
            text(&row.team),
            format!("{:?}", row.state).to_lowercase() + if row.kept { " (kept)" } else { "" },
            row.reason.as_ref().map_or_else(String::new, |reason| reason.code.clone()),
        ];
        cells.extend(tasks.iter().map(|task| number(row.tasks.get(task).copied().flatten())));
        cells.extend([
            number(row.raw),
            row.received_at.clone().unwrap_or_default(),
            late.map_or_else(String::new, Lateness::late_by_text),
            number(late.map(|lateness| lateness.factor)),
            number(row.points),
            text(&standing),
            codes.join(" "),
            text(&row.explanations.join(", ")),
            text(&row.sent),
            if row.on_roster { "yes" } else { "no" }.to_owned(),
            row.graded_at.clone().unwrap_or_default(),
        ]);
        table.push(cells);
    }
    table.save(path)
}

/// Content of `class.json`, for staff only.
#[derive(Serialize)]
struct ClassFile<'a> {
    schema: &'a str,
    assignment: &'a str,
    automatic_max: f64,
    provenance: &'a Provenance,
    rows: &'a [Row],
    similar: &'a [Group],
}

/// Writes `class.json`.
///
/// # Errors
/// If it cannot be written.
pub fn save_class(
    path: &Path,
    assignment: (&str, f64),
    provenance: &Provenance,
    rows: &[Row],
    similar: &[Group],
) -> Result<()> {
    let (assignment, automatic_max) = assignment;
    let file = ClassFile { schema: SCHEMA, assignment, automatic_max, provenance, rows, similar };
    output::write_json(path, &file)
}

/// Reads the rows of a `class.json`.
///
/// # Errors
/// If there is none, or it is of another version.
pub fn load_rows(path: &Path) -> Result<Vec<Row>> {
    #[derive(Deserialize)]
    struct ClassFile {
        schema: String,
        rows: Vec<Row>,
    }
    let bytes = std::fs::read(path).map_err(|error| Error::file(path, error))?;
    let file: ClassFile = serde_json::from_slice(&bytes).map_err(|error| Error::file(path, error))?;
    if file.schema != SCHEMA {
        return Err(Error::file(
            path,
            format!("this is {}, not {SCHEMA}: grade the class again", file.schema),
        ));
    }
    Ok(file.rows)
}
