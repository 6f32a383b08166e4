//! The manifest: receipt times of submissions, a CSV file written by staff.

use std::collections::BTreeMap;
use std::path::Path;

use jiff::Timestamp;
use jiff::tz::TimeZone;

use super::{Lateness, Policy, Standing, parse_received};
use crate::class::roster::{EMAIL, IDENTIFIER, LOGIN, participant};
use crate::table::Table;
use verdict::error::{Error, Result};

/// Receipt of one submission.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Receipt {
    /// Receipt time of the file; `None` if unknown.
    pub received_at: Option<Timestamp>,
    /// The MD5 checksum that the student sent, in hexadecimal.
    pub md5: Option<String>,
    /// Receipt time of the checksum.
    pub md5_received_at: Option<Timestamp>,
    /// File or folder of the submission, relative to the folder of the class; empty if the student sent only one.
    pub path: String,
    /// The file in the submission that is its source, by the end of its path; `None` if there is nothing to choose.
    pub source: Option<String>,
}

/// All receipts of a class. The columns of the file are `student` (login, number, e-mail address, or the name of the
/// submission's folder), `received_at`, and optionally `md5`, `md5_received_at`, `path`, `source` and `team`. A student who
/// sent several submissions has several rows. Tables of Moodle and ILIAS that tell when somebody handed in are manifests,
/// too.
#[derive(Clone, Debug, Default)]
pub struct Manifest {
    receipts: BTreeMap<String, Vec<Receipt>>,
    teams: BTreeMap<String, String>,
}

/// Columns with the time of submission in Moodle's grading worksheet and in ILIAS's table of an exercise.
const RECEIVED: &[&str] = &[
    "received_at",
    "Last modified (submission)",
    "Zuletzt geändert (Abgabe)",
    "Last Submission",
    "Letzte Abgabe",
];

impl Manifest {
    /// Reads the file. Times without an offset are in `zone`.
    ///
    /// # Errors
    /// The first invalid row, with its line.
    pub fn load(path: &Path, zone: &TimeZone) -> Result<Self> {
        let table = Table::load(path)?;
        let column = |name: &str| table.column(&[name]);
        let missing = |name: &str| Error::file(path, format!("there is no column `{name}`"));
        let own = column("student");
        let student =
            own.or_else(|| [LOGIN, EMAIL, IDENTIFIER, &["ID"]].iter().find_map(|names| table.column(names)));
        let student = student.ok_or_else(|| missing("student"))?;
        let received_at = table.column(RECEIVED).ok_or_else(|| missing("received_at"))?;
        let team = column("team");
        let (md5, md5_received_at, file) = (column("md5"), column("md5_received_at"), column("path"));
        let source = column("source");
        let mut manifest = Self::default();
        for row in &table.rows {
            let blame = |message: String| Error::Input(format!("{}:{}: {message}", path.display(), row.line));
            // Moodle writes `-` for "never".
            let cell = |column: Option<usize>| {
                column.map(|column| row.cell(column)).filter(|text| !matches!(*text, "" | "-"))
            };
            let time = |column: Option<usize>| {
                let in_column = |message: String| {
                    let name = column.map_or("", |column| table.header[column].as_str());
                    blame(format!("column `{name}`: {message}"))
                };
                cell(column).map(|text| parse_received(text, zone)).transpose().map_err(in_column)
            };
            let name = row.cell(student);
            let name = participant(name).unwrap_or(name).to_lowercase();
            if let Some(team) = cell(team) {
                manifest.teams.insert(name.clone(), team.to_owned());
            }
            if own.is_none() && cell(Some(received_at)).is_none() {
                // A table of everybody: this one handed in nothing.
                continue;
            }
            if name.is_empty() {
                return Err(blame(format!(
                    "column `{}` is empty: write whose submission it is",
                    table.header[student]
                )));
            }
            let md5 = cell(md5).map(str::to_lowercase);
            if md5.as_ref().is_some_and(|md5| md5.len() != 32 || !md5.bytes().all(|b| b.is_ascii_hexdigit()))
            {
                return Err(blame("column `md5`: an MD5 checksum has 32 hexadecimal digits".to_owned()));
            }
            let receipt = Receipt {
                received_at: time(Some(received_at))?,
                md5,
                md5_received_at: time(md5_received_at)?,
                path: cell(file).unwrap_or_default().to_owned(),
                source: cell(source).map(str::to_owned),
            };
            manifest.receipts.entry(name).or_default().push(receipt);
        }
        Ok(manifest)
    }

    /// Teams by the names of students, in lower case.
    pub fn teams(&self) -> &BTreeMap<String, String> {
        &self.teams
    }

    /// Names of all students in it, in lower case.
    pub fn students(&self) -> impl Iterator<Item = &str> {
        self.receipts.keys().map(String::as_str)
    }

    /// Receipts of a student who goes by these names.
    pub fn of(&self, student: &[&str]) -> &[Receipt] {
        let found = student.iter().find_map(|name| self.receipts.get(&name.trim().to_lowercase()));
        found.map_or(&[], Vec::as_slice)
    }
}

/// The submission that counts: the last one that is accepted, or else the last one. Those with the same receipt time
/// count in the order of the manifest.
pub(crate) fn the_one_that_counts<'a>(
    policy: &Policy,
    student: &[&str],
    receipts: &'a [Receipt],
    checksums: impl Fn(&Receipt) -> Vec<String>,
) -> Option<(&'a Receipt, Lateness)> {
    receipts
        .iter()
        .map(|receipt| (receipt, policy.judge(student, Some(receipt), &checksums(receipt))))
        .max_by_key(|(receipt, lateness)| (lateness.standing != Standing::NotAccepted, receipt.received_at))
}
