//! What is kept of a graded submission, beside its report.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use arty::integrator::Technique;
use serde::{Deserialize, Serialize};

use intake::Intake;
use present::page::{pages_beside, pictures_beside};
use present::words;
use verdict::check::{CheckKind, CheckResult, Evidence, Reason, Verdict};
use verdict::error::{Error, Result};
use verdict::output;
use verdict::report::Report;
use verdict::submission::{Explanation, IntakeFinding};

/// The version of the format.
const SCHEMA: &str = "arty-record/1";

/// What is kept of a submission. Its points are raw: what a date can change is not among them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// The version of the format.
    pub schema: String,
    /// Hash of all that the verdicts depend on.
    pub key: String,
    /// Why there are no points, or fewer than there could be: of the refusals of [`intake::Refusal`] one, or
    /// `build`, `timeout`, `crash`, `violation`.
    pub reason: Option<IntakeFinding>,
    /// What is odd about it.
    pub notes: Vec<IntakeFinding>,
    /// Raw points of each task; none where a person marks, or not all checks were run.
    pub tasks: BTreeMap<String, Option<f64>>,
    /// The verdict of each check, by task and check.
    pub checks: BTreeMap<String, Verdict>,
    /// The sum of raw points.
    pub earned: f64,
    /// Written explanations.
    pub explanations: Vec<Explanation>,
    /// MD5 of the files that came.
    pub checksums: Vec<String>,
    /// BLAKE3 of the source; empty if there is none.
    pub source: String,
    /// When it was graded.
    pub graded_at: String,
    /// How long compiling and running took.
    pub seconds: f64,
    /// The likeliest cause of what is wrong.
    #[serde(default)]
    pub mistake: Option<String>,
    /// Time for a given noise: the variance of multiple importance sampling relative to the solution's × seconds for a
    /// sample, as the geometric mean over the scenes of the check `efficiency`. None unless the means are right.
    #[serde(default)]
    pub work: Option<f64>,
    /// BLAKE3 of `report.json`; empty if there is none.
    pub report: String,
}

impl Record {
    /// Of a submission that cannot be graded, or has been.
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
            report: String::new(),
        }
    }
}

/// See [`Record::work`].
fn work(report: &Report) -> Option<f64> {
    let looked_at = |check: &&CheckResult| {
        check.id.kind == CheckKind::Efficiency && check.id.technique == Technique::Mis && check.samples > 0
    };
    // What leaves light out has little noise.
    if report
        .checks
        .iter()
        .any(|check| check.id.technique == Technique::Mis && check.verdict == Verdict::Fail)
    {
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

/// The one thing that a student has to know first.
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

/// The folder of one submission's results.
#[derive(Clone, Debug)]
pub(super) struct ResultDir(PathBuf);

impl ResultDir {
    /// In the folder of all results.
    pub(super) fn new(out: &Path, key: &str) -> Self {
        Self(out.join("submissions").join(key))
    }

    pub(super) fn report(&self) -> PathBuf {
        self.0.join("report.json")
    }

    fn record(&self) -> PathBuf {
        self.0.join("record.json")
    }

    /// The student's edition of the page, and the tutor's.
    pub(super) fn pages(&self) -> [PathBuf; 2] {
        pages_beside(&self.report())
    }

    /// What the pages were made of: a hash.
    pub(super) fn made_of(&self) -> PathBuf {
        self.0.join("pages.hash")
    }

    /// The pictures of the pages.
    pub(super) fn pictures(&self) -> PathBuf {
        pictures_beside(&self.report())
    }

    /// The picture for the page of the class.
    pub(super) fn thumbnail(&self) -> PathBuf {
        self.0.join("thumbnail.png")
    }

    /// The record, whatever became of its report.
    pub(super) fn record_alone(&self) -> Option<Record> {
        let record: Record = serde_json::from_slice(&std::fs::read(self.record()).ok()?).ok()?;
        (record.schema == SCHEMA).then_some(record)
    }

    /// The record, if there is a whole one whose report is whole, too.
    pub(super) fn load(&self) -> Option<Record> {
        let record = self.record_alone()?;
        let report = std::fs::read(self.report()).map_or_else(|_| String::new(), |bytes| hash(&bytes));
        (record.report == report).then_some(record)
    }

    /// Keeps report and record. The record comes last and names the report: whatever is interrupted, what
    /// [`Self::load`] gives belongs together.
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

    /// Files that a killed grader had begun.
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
