//! Results of grading variants, kept on disk so that no variant is graded twice.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use rayon::iter::{IndexedParallelIterator, IntoParallelRefIterator, ParallelIterator};
use serde::{Deserialize, Serialize};

use super::Variant;
use crate::output::{create_folder, failed};
use harness::tree_hash::{hash_judging, hash_tree};
use harness::workspace::Workspace;
use judge::grade::{Grader, Options};
use verdict::check::Verdict;
use verdict::error::{Error, Result};
use verdict::report::Report;
use verdict::submission::Submission;

/// The result of one grade of one variant: a line of the ledger.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Record {
    /// Hash of everything that the result depends on, except the seed.
    pub key: String,
    /// Name of the variant.
    pub variant: String,
    /// Seed of the grade.
    pub seed: u64,
    /// Points earned and maximum points, by task. Tasks that are graded by hand are missing.
    pub tasks: BTreeMap<String, [f64; 2]>,
    /// Verdict by task and check, separated by a space.
    pub checks: BTreeMap<String, Verdict>,
    /// Messages of rustc, if it does not compile.
    pub build_failure: Option<String>,
    /// Seconds of compiling and running.
    pub seconds: f64,
}

/// A file of results, one JSON object per line, beside a folder of reports.
pub struct Ledger {
    path: PathBuf,
    records: Vec<Record>,
    /// Hash of everything that is the same for all variants.
    base: blake3::Hash,
}

impl Ledger {
    /// Opens the ledger in a folder, which is created if it is missing.
    ///
    /// # Errors
    /// If the folder cannot be created, or the ledger or an input of the grades cannot be read.
    pub fn open(folder: &Path, workspace: &Workspace, assignment: &str) -> Result<Self> {
        create_folder(&folder.join(REPORTS))?;
        let path = folder.join(RESULTS);
        let text = match std::fs::read_to_string(&path) {
            Ok(text) => text,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => String::new(),
            Err(error) => return Err(Error::file(&path, error)),
        };
        // A line that was cut off or is of an older format does not parse: that variant is graded again.
        let records = text.lines().filter_map(|line| serde_json::from_str(line).ok()).collect();
        Ok(Self { path, records, base: hash_of_inputs(workspace, assignment)? })
    }

    /// The results of a variant as it is now.
    pub fn records(&self, variant: &Variant) -> Vec<&Record> {
        let key = self.key(variant);
        self.records.iter().filter(|record| record.key == key && record.variant == variant.id).collect()
    }

    /// Grades variants whose results are missing: `options.threads` at a time, each with one thread. Calls `on_record` for
    /// each result once it is written; begins no further grade once `stop` returns true.
    ///
    /// # Errors
    /// If the harness fails, or a result cannot be written. Faults of a variant are results.
    pub fn grade(
        &mut self,
        workspace: &Workspace,
        variants: &[&Variant],
        options: &Options,
        stop: impl Fn() -> bool + Sync,
        on_record: impl Fn(&Record) + Sync,
    ) -> Result<()> {
        let is_known = |variant: &&Variant| {
            self.records(variant).iter().any(|it| it.seed == options.seed && self.report_file(it).is_file())
        };
        let missing: Vec<&Variant> = variants.iter().copied().filter(|variant| !is_known(variant)).collect();
        if missing.is_empty() {
            return Ok(());
        }
        let grader = Grader::new(workspace, &Options { threads: 1, ..options.clone() })?;
        let trouble = |error: std::io::Error| failed(&self.path, error);
        let file = std::fs::OpenOptions::new().create(true).append(true).open(&self.path).map_err(trouble)?;
        let written = Mutex::new((file, Vec::new()));
        let grade_one = |variant: &&Variant| -> Result<()> {
            if stop() {
                return Ok(());
            }
            let path = PathBuf::from(format!("{}.rs", variant.id));
            let report = grader.grade(&Submission { path, source: variant.source.clone() }, |_| {})?;
            let record = record(self.key(variant), variant, options.seed, &report);
            let file = self.report_file(&record);
            report.save(&file)?;
            let line = serde_json::to_string(&record).map_err(|error| Error::Harness(error.to_string()))?;
            on_record(&record);
            let mut written = written.lock().unwrap_or_else(PoisonError::into_inner);
            writeln!(written.0, "{line}").map_err(trouble)?;
            written.1.push(record);
            Ok(())
        };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(options.threads).build();
        let pool = pool.map_err(|error| Error::Harness(format!("no threads: {error}")))?;
        let outcome = pool.install(|| missing.par_iter().with_max_len(1).try_for_each(grade_one));
        let (_, records) = written.into_inner().unwrap_or_else(PoisonError::into_inner);
        self.records.extend(records);
        outcome
    }

    /// The report of a result.
    ///
    /// # Errors
    /// If it cannot be read.
    pub fn report(&self, record: &Record) -> Result<Report> {
        Report::load(&self.report_file(record))
    }

    fn report_file(&self, record: &Record) -> PathBuf {
        self.path.with_file_name(REPORTS).join(report_name(&record.variant, record.seed, &record.key))
    }

    fn key(&self, variant: &Variant) -> String {
        let mut hasher = blake3::Hasher::new();
        hasher.update(self.base.as_bytes());
        hasher.update(variant.source.as_bytes());
        hasher.finalize().to_hex()[..32].to_owned()
    }
}

/// Name of the file of results in a ledger's folder.
pub(crate) const RESULTS: &str = "results.jsonl";

/// Name of the folder of reports in a ledger's folder.
pub(crate) const REPORTS: &str = "reports";

/// Name of the report of one grade.
pub(crate) fn report_name(variant: &str, seed: u64, key: &str) -> String {
    format!("{variant}-{seed}-{}.json", key.get(..8).unwrap_or(key))
}

fn record(key: String, variant: &Variant, seed: u64, report: &Report) -> Record {
    let tasks = report.tasks.iter();
    let checks = report.checks.iter();
    Record {
        key,
        variant: variant.id.clone(),
        seed,
        tasks: tasks.filter_map(|task| Some((task.id.clone(), [task.points?, task.max]))).collect(),
        checks: checks.map(|check| (format!("{} {}", check.task, check.id), check.verdict.clone())).collect(),
        build_failure: report.submission.build_failure.as_ref().map(|failure| failure.messages.clone()),
        seconds: report.cost.build + report.cost.run,
    }
}

/// Hash of everything that a grade depends on beside the submission and the seed: the crates that can change a verdict,
/// scenes, references and the rubric.
///
/// # Errors
/// If a file cannot be read.
pub fn hash_of_inputs(workspace: &Workspace, assignment: &str) -> Result<blake3::Hash> {
    let root = workspace.root();
    let mut hasher = blake3::Hasher::new();
    hash_judging(workspace, &mut hasher)?;
    hash_tree(&root.join("references"), &[], &mut hasher)?;
    hash_tree(&workspace.assignment(assignment).rubric_file(), &[], &mut hasher)?;
    Ok(hasher.finalize())
}
