//! Grades read from a folder: verdicts and points of reports of version 1 or 2.

use std::collections::BTreeMap;
use std::fmt;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use serde_json::Value;

use crate::mutants::{REPORTS, RESULTS, report_name};
use verdict::check::CheckId;
use verdict::error::{Error, Result};
use verdict::report::SCHEMA;

/// The format before [`SCHEMA`].
const SCHEMA_1: &str = "arty-report/1";

/// Name of a report in a folder of its own.
const REPORT: &str = "report.json";

/// Grades by submission and seed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Grades(pub BTreeMap<GradeId, Grade>);

/// A submission and the seed of its grade.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct GradeId {
    /// Name of the variant, or of the folder of the report.
    pub name: String,
    /// Seed of the grade.
    pub seed: u64,
}

/// One grade.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Grade {
    /// Points earned by task. Tasks without automatic points are missing.
    pub points: BTreeMap<String, f64>,
    /// How each check ended, by task and identity.
    pub checks: BTreeMap<(String, CheckId), Ending>,
}

/// How a check ended: a verdict without its reason.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the variants of verdict::check::Verdict")]
pub enum Ending {
    Pass,
    Fail,
    Inconclusive,
    Skipped,
    NotRun,
}

/// The part of a report that is compared.
#[derive(Deserialize)]
struct Report {
    schema: String,
    tasks: Vec<Task>,
    checks: Vec<Check>,
    provenance: Provenance,
}

#[derive(Deserialize)]
struct Task {
    id: String,
    points: Option<f64>,
}

#[derive(Deserialize)]
struct Check {
    id: String,
    task: String,
    /// A word, or from version 2 on an object whose only key is the word.
    verdict: Value,
    /// Version 1 only.
    #[serde(default)]
    explanation: String,
}

#[derive(Deserialize)]
struct Provenance {
    /// Text in version 1, a number in version 2.
    seed: Value,
}

/// The part of a ledger's line that names its report.
#[derive(Deserialize)]
struct Line {
    key: String,
    variant: String,
    seed: u64,
}

impl Grades {
    /// Reads the folder of a ledger, as `cargo lab mutants --out` writes it, or a folder with folders that each hold a
    /// `report.json`. Of several grades of a variant with one seed, the latest counts.
    ///
    /// # Errors
    /// If the folder holds no grades, or a report cannot be read.
    pub fn load(folder: &Path) -> Result<Self> {
        let ledger = folder.join(RESULTS);
        let grades = if ledger.is_file() { of_ledger(folder, &ledger)? } else { of_folders(folder)? };
        if grades.0.is_empty() {
            let message = format!("no grades: neither {RESULTS} nor folders with a {REPORT}");
            return Err(Error::file(folder, message));
        }
        Ok(grades)
    }
}

fn of_ledger(folder: &Path, ledger: &Path) -> Result<Grades> {
    let text = std::fs::read_to_string(ledger).map_err(|error| Error::file(ledger, error))?;
    let mut keys = BTreeMap::new();
    // The last line may have been cut off.
    for Line { key, variant, seed } in text.lines().filter_map(|line| serde_json::from_str(line).ok()) {
        keys.insert(GradeId { name: variant, seed }, key);
    }
    let mut grades = Grades::default();
    for (id, key) in keys {
        let path = folder.join(REPORTS).join(report_name(&id.name, id.seed, &key));
        grades.0.insert(id, read(&path)?.1);
    }
    Ok(grades)
}

fn of_folders(folder: &Path) -> Result<Grades> {
    let failed = |error: std::io::Error| Error::file(folder, error);
    let entries = std::fs::read_dir(folder).map_err(failed)?;
    let mut grades = Grades::default();
    for entry in entries {
        let entry: PathBuf = entry.map_err(failed)?.path();
        let (path, name) = (entry.join(REPORT), entry.file_name().unwrap_or_default());
        if path.is_file() {
            let (seed, grade) = read(&path)?;
            grades.0.insert(GradeId { name: name.to_string_lossy().into_owned(), seed }, grade);
        }
    }
    Ok(grades)
}

/// Seed and grade of a report.
fn read(path: &Path) -> Result<(u64, Grade)> {
    let bytes = std::fs::read(path).map_err(|error| Error::file(path, error))?;
    parse(&bytes).map_err(|message| Error::file(path, message))
}

fn parse(bytes: &[u8]) -> std::result::Result<(u64, Grade), String> {
    let report: Report =
        serde_json::from_slice(bytes).map_err(|error| format!("not a report of the grader: {error}"))?;
    let is_old = match report.schema.as_str() {
        SCHEMA => false,
        SCHEMA_1 => true,
        other => return Err(format!("a report of format {other}, not {SCHEMA_1} or {SCHEMA}")),
    };
    let mut grade = Grade::default();
    grade.points.extend(report.tasks.into_iter().filter_map(|task| Some((task.id, task.points?))));
    for check in report.checks {
        let id = if is_old { id_of_version_1(&check.id) } else { check.id.clone() };
        let ending = ending(&check, is_old).ok_or_else(|| format!("{id}: verdict {}", check.verdict))?;
        grade.checks.insert((check.task, id.parse()?), ending);
    }
    let seed = match report.provenance.seed {
        Value::String(seed) => seed.parse().ok(),
        seed => seed.as_u64(),
    };
    Ok((seed.ok_or("the seed is not a number")?, grade))
}

/// The present form of a check's identity in version 1.
fn id_of_version_1(id: &str) -> String {
    id.strip_suffix("/hits-off").map_or_else(|| id.to_owned(), |rest| format!("{rest}/emission-off"))
}

fn ending(check: &Check, is_old: bool) -> Option<Ending> {
    let word = match &check.verdict {
        Value::String(word) => word,
        Value::Object(map) => map.keys().next()?,
        _ => return None,
    };
    Some(match word.as_str() {
        "pass" => Ending::Pass,
        // Version 1 has no other mark of a check that was not run for lack of time.
        "fail" if is_old && check.explanation.starts_with("not run") => Ending::NotRun,
        "fail" => Ending::Fail,
        "inconclusive" => Ending::Inconclusive,
        "left-out" | "skipped" => Ending::Skipped,
        "error" | "not-run" => Ending::NotRun,
        _ => return None,
    })
}

impl fmt::Display for GradeId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, seed {}", self.name, self.seed)
    }
}

impl fmt::Display for Ending {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Pass => "pass",
            Self::Fail => "fail",
            Self::Inconclusive => "inconclusive",
            Self::Skipped => "skipped",
            Self::NotRun => "not run",
        })
    }
}

#[cfg(test)]
mod tests {
    use verdict::check::{NotRun, SkipReason, Verdict};

    use super::*;

    const OLD: &str = r#"{"schema":"arty-report/1","provenance":{"seed":"7"},
        "tasks":[{"id":"a","points":1.5},{"id":"by hand","points":null}],
        "checks":[{"id":"mean-bias/x/nee/8/hits-off","task":"a","verdict":"left-out","explanation":"not run, since"},
        {"id":"mean-bias/x/nee/8","task":"a","verdict":"fail","explanation":"not run, because"},
        {"id":"mean-bias/x/nee/1","task":"a","verdict":"fail","explanation":"too bright"}]}"#;

    fn endings(grade: &Grade) -> Vec<(String, Ending)> {
        grade.checks.iter().map(|((_, id), ending)| (id.to_string(), *ending)).collect()
    }

    #[test]
    fn a_report_of_version_1_is_read_in_the_terms_of_version_2() {
        let (seed, grade) = parse(OLD.as_bytes()).expect("it is a report");
        assert_eq!((seed, grade.points.len(), grade.points["a"]), (7, 1, 1.5));
        let expected = [
            ("mean-bias/x/nee/1", Ending::Fail),
            ("mean-bias/x/nee/8/emission-off", Ending::Skipped),
            ("mean-bias/x/nee/8", Ending::NotRun),
        ];
        assert_eq!(endings(&grade), expected.map(|(id, ending)| (id.to_owned(), ending)));
    }

    #[test]
    fn every_verdict_of_a_present_report_is_read() {
        let id: CheckId = "mean-bias/x/nee/8/emission-off".parse().expect("it is an id");
        for (verdict, ending) in [
            (Verdict::Pass, Ending::Pass),
            (Verdict::Fail, Ending::Fail),
            (Verdict::Inconclusive, Ending::Inconclusive),
            (Verdict::Skipped { why: SkipReason::PointsLostTo(Some(id.clone())) }, Ending::Skipped),
            (Verdict::Skipped { why: SkipReason::PointsLostTo(None) }, Ending::Skipped),
            (Verdict::NotRun { why: NotRun::OutOfTime }, Ending::NotRun),
        ] {
            let report = serde_json::json!({
                "schema": SCHEMA,
                "provenance": { "seed": 7 },
                "tasks": [{ "id": "a", "points": 2.0 }],
                "checks": [{ "id": id, "task": "a", "verdict": verdict }],
            });
            let (seed, grade) = parse(report.to_string().as_bytes()).expect("it is a report");
            assert_eq!((seed, endings(&grade)), (7, vec![(id.to_string(), ending)]));
        }
    }

    #[test]
    fn other_formats_and_empty_folders_are_errors() {
        assert!(
            parse(OLD.replace("report/1", "report/9").as_bytes()).is_err_and(|it| it.contains("report/9"))
        );
        assert!(parse(OLD.replace("left-out", "perhaps").as_bytes()).is_err_and(|it| it.contains("perhaps")));
        assert!(parse(b"{}").is_err());
        let folder = tempfile::tempdir().expect("a temporary folder");
        assert!(Grades::load(folder.path()).is_err_and(|error| error.to_string().contains("no grades")));
    }

    #[test]
    fn a_ledger_and_plain_folders_hold_the_same_grades() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let (ledger, plain) = (folder.path().join("ledger"), folder.path().join("plain"));
        for path in [ledger.join(REPORTS), plain.join("one")] {
            std::fs::create_dir_all(path).expect("it can be created");
        }
        let write = |path: PathBuf, text: &str| std::fs::write(path, text).expect("it can be written");
        write(plain.join("one").join(REPORT), OLD);
        let line = |key: &str| format!(r#"{{"key":"{key}","variant":"one","seed":7}}"#);
        // The earlier grade's report is gone; the last line was cut off.
        write(
            ledger.join(RESULTS),
            &[line("00000000aa"), line("11111111bb"), "{\"key\"".to_owned()].join("\n"),
        );
        write(ledger.join(REPORTS).join("one-7-11111111.json"), OLD);
        let grades = Grades::load(&plain).expect("there is a grade");
        assert_eq!(grades.0.len(), 1);
        assert_eq!(Grades::load(&ledger).expect("there is a grade"), grades);
    }
}
