//! The record of a graded submission, stored beside its report.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use intake::Intake;
use present::page::{pages_beside, pictures_beside};
use present::words;
use verdict::check::{CheckKind, CheckResult, Evidence, Reason, Verdict};
use verdict::error::{Error, Result};
use verdict::output;
use verdict::report::Report;
use verdict::sandbox::Level;
use verdict::submission::{Explanation, IntakeFinding};

/// Version of the format.
const SCHEMA: &str = "arty-record/1";

/// The record of a submission. Its points are raw: nothing in it depends on a date.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Version of the format.
    pub schema: String,
    /// Hash of everything that verdicts depend on, the submission included.
    pub key: String,
    /// Main reason why points are missing: the code of an [`intake::Refusal`], or `build`, `timeout`, `crash`, `violation`.
    pub reason: Option<IntakeFinding>,
    /// Notes of intake.
    pub notes: Vec<IntakeFinding>,
    /// Raw points of each task; none where a tutor grades, or where not all checks were run.
    pub tasks: BTreeMap<String, Option<f64>>,
    /// Verdicts, by task and check.
    pub checks: BTreeMap<String, Verdict>,
    /// Sum of raw points.
    pub earned: f64,
    /// Written explanations.
    pub explanations: Vec<Explanation>,
    /// MD5 of the files that were received.
    pub checksums: Vec<String>,
    /// BLAKE3 of the source; empty if there is none.
    pub source: String,
    /// Time of grading.
    pub graded_at: String,
    /// Seconds for compiling and running.
    pub seconds: f64,
    /// Most likely cause of the failures.
    #[serde(default)]
    pub mistake: Option<String>,
    /// Work for a given noise with multiple importance sampling: variance relative to the solution's × seconds per sample,
    /// as a geometric mean over the scenes of the check `efficiency`. None if any check with that technique fails.
    #[serde(default)]
    pub work: Option<f64>,
    /// Sandbox in which it was compiled and run; none if it was not.
    #[serde(default)]
    pub sandbox: Option<Level>,
    /// BLAKE3 of `report.json`; empty if there is none.
    pub report: String,
}

impl Record {
    /// Creates the record of a submission; without a report, of one that is not graded.
    pub(super) fn new(key: String, intake: &Intake, tasks: &[String], report: Option<&Report>) -> Self {
        let reason = match (&intake.outcome, report) {
            (Err(refusal), _) => Some(IntakeFinding::from(refusal)),
            (Ok(_), Some(report)) => reason(report),
            (Ok(_), None) => None,
        };
        // What cannot be graded earns nothing in the tasks that are graded.
        let nothing = tasks.iter().map(|task| (task.clone(), Some(0.0))).collect();
        Self {
            schema: SCHEMA.to_owned(),
            key,
            reason,
            notes: intake.notes.iter().map(IntakeFinding::from).collect(),
            tasks: report.map_or(nothing, |report| {
                report.tasks.iter().map(|task| (task.id.clone(), task.points)).collect()
            }),
            checks: report.map_or_else(BTreeMap::new, |report| {
                report
                    .checks
                    .iter()
                    .map(|check| (format!("{} {}", check.task, check.id), check.verdict.clone()))
                    .collect()
            }),
            earned: report.map_or(0.0, |report| report.points.earned),
            explanations: intake.explanations.clone(),
            checksums: intake.checksums.clone(),
            source: report.map_or_else(String::new, |report| report.submission.hash.clone()),
            graded_at: jiff::Timestamp::now().strftime("%FT%TZ").to_string(),
            seconds: report.map_or(0.0, |report| report.cost.build + report.cost.run),
            mistake: report.and_then(|report| report.diagnosis.first()).map(|it| words::title(&it.cause)),
            work: report.and_then(work),
            sandbox: report.map(|report| report.sandbox.level),
            report: String::new(),
        }
    }
}

/// Computes [`Record::work`].
fn work(report: &Report) -> Option<f64> {
    // The one that the others lead to.
    let last = report.checks.iter().map(|check| check.id.technique).max()?;
    let looked_at = |check: &&CheckResult| {
        check.id.kind == CheckKind::Efficiency && check.id.technique == last && check.samples > 0
    };
    // What leaves light out has little noise.
    if report.checks.iter().any(|check| check.id.technique == last && check.verdict == Verdict::Fail) {
        return None;
    }
    let logs: Vec<f64> = report
        .checks
        .iter()
        .filter(looked_at)
        .map(|check| {
            let Some(Evidence::Efficiency(noise)) = &check.evidence else { return None };
            let own = noise.ratios.iter().find(|it| it.technique == check.id.technique)?;
            let work = own.ratio * check.seconds / check.samples as f64;
            (check.verdict == Verdict::Pass && work > 0.0).then(|| work.ln())
        })
        .collect::<Option<_>>()?;
    (!logs.is_empty()).then(|| (logs.iter().sum::<f64>() / logs.len() as f64).exp())
}

/// Main reason why points are missing.
fn reason(report: &Report) -> Option<IntakeFinding> {
    if let Some(failure) = &report.submission.build_failure {
        let line = failure.line.map_or_else(String::new, |line| format!(" (line {line})"));
        return Some(IntakeFinding {
            code: "build".to_owned(),
            message: format!("it does not compile{line}"),
        });
    }
    let code = |reason| match reason {
        Reason::Timeout => Some("timeout"),
        Reason::Crash => Some("crash"),
        Reason::Violation => Some("violation"),
        _ => None,
    };
    report.checks.iter().find_map(|check| {
        let code = code(check.reason)?.to_owned();
        Some(IntakeFinding { code, message: format!("{}: {}", check.id, words::explanation(check)) })
    })
}

/// Result folder of one submission.
#[derive(Clone, Debug)]
pub(super) struct ResultDir(PathBuf);

impl ResultDir {
    /// Its path in the result folder of a class.
    pub(super) fn new(out: &Path, key: &str) -> Self {
        Self(out.join("submissions").join(key))
    }

    /// Path of the record on disk.
    pub(super) fn path(&self) -> &Path {
        &self.0
    }

    /// Path of the report.
    pub(super) fn report(&self) -> PathBuf {
        self.0.join("report.json")
    }

    fn record(&self) -> PathBuf {
        self.0.join("record.json")
    }

    /// Paths of the student's page and the tutor's page.
    pub(super) fn pages(&self) -> [PathBuf; 2] {
        pages_beside(&self.report())
    }

    /// Path of the hash of the data that the pages were made from.
    pub(super) fn made_of(&self) -> PathBuf {
        self.0.join("pages.hash")
    }

    /// Path of the images of the pages.
    pub(super) fn pictures(&self) -> PathBuf {
        pictures_beside(&self.report())
    }

    /// Path of the report on a submission that was refused.
    pub(super) fn refusal(&self) -> PathBuf {
        self.0.join("refusal.json")
    }

    /// Keeps the report on a submission that was refused; removes an earlier one if there is none. It is no `report.json`:
    /// nothing was graded.
    pub(super) fn keep_refusal(&self, refusal: Option<&Report>) -> Result<()> {
        match refusal {
            None => output::remove(&self.refusal()),
            Some(report) => {
                output::create_folder(&self.0)?;
                report.save(&self.refusal())
            }
        }
    }

    /// Path of the source that was graded.
    pub(super) fn source(&self) -> PathBuf {
        self.0.join("source.rs")
    }

    /// Keeps the source beside its results, to be compared with others; removes an earlier one if there is none.
    pub(super) fn keep_source(&self, source: Option<&str>) -> Result<()> {
        match source {
            None => output::remove(&self.source()),
            Some(source) if std::fs::read(self.source()).is_ok_and(|kept| kept == source.as_bytes()) => {
                Ok(())
            }
            Some(source) => {
                output::create_folder(&self.0)?;
                output::write_bytes(&self.source(), source)
            }
        }
    }

    /// Path of the image for the page of the class.
    pub(super) fn thumbnail(&self) -> PathBuf {
        self.0.join("thumbnail.png")
    }

    /// Reads the record without checking its report; `None` if it is missing or not valid.
    pub(super) fn record_alone(&self) -> Option<Record> {
        let record: Record = serde_json::from_slice(&std::fs::read(self.record()).ok()?).ok()?;
        (record.schema == SCHEMA).then_some(record)
    }

    /// Reads the record; `None` if it or its report is missing or incomplete.
    pub(super) fn load(&self) -> Option<Record> {
        let record = self.record_alone()?;
        let report = std::fs::read(self.report()).map_or_else(|_| String::new(), |bytes| hash(&bytes));
        (record.report == report).then_some(record)
    }

    /// Saves report and record. The record is written last and contains the report's hash, so that after any interruption
    /// [`Self::load`] only returns a record that belongs to its report.
    pub(super) fn save(&self, record: &mut Record, report: Option<&Report>) -> Result<()> {
        output::create_folder(&self.0)?;
        self.remove_leftovers();
        match report {
            Some(report) => {
                report.save(&self.report())?;
                let bytes =
                    std::fs::read(self.report()).map_err(|error| Error::file(&self.report(), error))?;
                record.report = hash(&bytes);
            }
            None => {
                record.report = String::new();
                output::remove(&self.report())?;
            }
        }
        output::write_json(&self.record(), record)
    }

    /// Copies report and images of the same submission from another folder, and saves the record after them.
    pub(super) fn save_copy(&self, record: &Record, from: &Self) -> Result<()> {
        output::create_folder(&self.0)?;
        self.remove_leftovers();
        for file in [Self::report, Self::pictures, Self::thumbnail] {
            match std::fs::read(file(from)) {
                Ok(bytes) => output::write_bytes(&file(self), bytes)?,
                Err(error) if error.kind() == std::io::ErrorKind::NotFound => output::remove(&file(self))?,
                Err(error) => return Err(Error::file(&file(from), error)),
            }
        }
        output::write_json(&self.record(), record)
    }

    /// Removes incomplete files of a grader that was killed.
    fn remove_leftovers(&self) {
        for entry in std::fs::read_dir(&self.0).into_iter().flatten().flatten() {
            let name = entry.file_name();
            let name = name.to_string_lossy();
            if name.starts_with('.') && name.ends_with(".part") {
                // It is in nobody's way if it stays.
                let _ = std::fs::remove_file(entry.path());
            }
        }
    }
}

fn hash(bytes: &[u8]) -> String {
    blake3::hash(bytes).to_hex().to_string()
}
