//! Results of grading variants, kept so that nothing is computed twice.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use rayon::iter::{IndexedParallelIterator, IntoParallelRefIterator, ParallelIterator};
use serde::{Deserialize, Serialize};

use super::Variant;
use harness::tree_hash::{hash_judging, hash_tree};
use harness::workspace::Workspace;
use judge::grade::{Grader, Options};
use verdict::error::{Error, Result};
use verdict::report::{Report, Verdict};
use verdict::submission::Submission;

/// What one grade of one variant has found: a line of the ledger.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Record {
    /// Hash of all that the result depends on, but for the seed.
    pub key: String,
    /// The variant's name.
    pub variant: String,
    /// The seed of the grade.
    pub seed: u64,
    /// For each automatic task the points earned and those it is worth.
    pub tasks: BTreeMap<String, [f64; 2]>,
    /// For each check, named by task and check, its verdict.
    pub checks: BTreeMap<String, Verdict>,
    /// What rustc said, if it does not compile.
    pub build_failure: Option<String>,
    /// How long compiling and running took.
    pub seconds: f64,
}

/// A file of results, a JSON object a line.
pub struct Ledger {
    path: PathBuf,
    records: Vec<Record>,
    /// Hash of all that is the same for all variants.
    base: blake3::Hash,
}

impl Ledger {
    /// Opens the ledger in a folder, which is made if it is not there.
    ///
    /// # Errors
    /// If the ledger, or anything that the results depend on, cannot be read.
    pub fn open(folder: &Path, workspace: &Workspace, assignment: &str) -> Result<Self> {
        let reports = folder.join("reports");
        std::fs::create_dir_all(&reports).map_err(|error| Error::file(&reports, error))?;
        let path = folder.join("results.jsonl");
        let text = match std::fs::read_to_string(&path) {
            Ok(text) => text,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => String::new(),
            Err(error) => return Err(Error::file(&path, error)),
        };
        // A line that was cut off, or is of an older format, is a result to be computed again.
        let records = text.lines().filter_map(|line| serde_json::from_str(line).ok()).collect();
        Ok(Self { path, records, base: hash_of_inputs(workspace, assignment)? })
    }

    /// The results of a variant as it is now.
    pub fn records(&self, variant: &Variant) -> Vec<&Record> {
        let key = self.key(variant);
        self.records.iter().filter(|record| record.key == key && record.variant == variant.id).collect()
    }

    /// Grades variants, unless the result is there already: `jobs` at a time, each with one thread, so that none waits for
    /// another. `on_record` is told of each result as it is written; no new one is begun once `stop` says so.
    ///
    /// # Errors
    /// What is not the variants' doing.
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
        let trouble = |error: std::io::Error| Error::file(&self.path, error);
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
            arty::image::write_aside(&file, |writer| serde_json::to_writer(writer, &report))?;
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

    /// The whole report of a result.
    ///
    /// # Errors
    /// If it is not there.
    pub fn report(&self, record: &Record) -> Result<Report> {
        Report::load(&self.report_file(record))
    }

    fn report_file(&self, record: &Record) -> PathBuf {
        let name = format!("{}-{}-{}.json", record.variant, record.seed, &record.key[..8]);
        self.path.with_file_name("reports").join(name)
    }

    fn key(&self, variant: &Variant) -> String {
        let mut hasher = blake3::Hasher::new();
        hasher.update(self.base.as_bytes());
        hasher.update(variant.source.as_bytes());
        hasher.finalize().to_hex()[..32].to_owned()
    }
}

fn record(key: String, variant: &Variant, seed: u64, report: &Report) -> Record {
    let tasks = report.tasks.iter();
    let checks = report.checks.iter();
    Record {
        key,
        variant: variant.id.clone(),
        seed,
        tasks: tasks.filter_map(|task| Some((task.id.clone(), [task.points?, task.max]))).collect(),
        checks: checks.map(|check| (format!("{} {}", check.task, check.id), check.verdict)).collect(),
        build_failure: report.submission.build_failure.as_ref().map(|failure| failure.messages.clone()),
        seconds: report.cost.build + report.cost.run,
    }
}

/// Over the rubric, scenes and references, the framework and all of the grader but this command.
pub fn hash_of_inputs(workspace: &Workspace, assignment: &str) -> Result<blake3::Hash> {
    let root = workspace.root();
    let mut hasher = blake3::Hasher::new();
    hash_judging(workspace, &mut hasher)?;
    hash_tree(&root.join("references"), &[], &mut hasher)?;
    hash_tree(&workspace.assignment(assignment).join("rubric.yml"), &[], &mut hasher)?;
    Ok(hasher.finalize())
}
