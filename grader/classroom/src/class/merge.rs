//! Merges the results of shards into those of the class.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use jiff::tz::TimeZone;

use super::Outcome;
use super::pages::PageMaker;
use super::record::ResultDir;
use super::shard::ShardFile;
use crate::marks::Marks;
use crate::policy::zone;
use verdict::error::{Error, Result};
use verdict::output;
use verdict::rubric::Rubric;

/// Merges shards into `out`: copies the results of all submissions, and returns the rows with their marks and penalties.
/// Pages that shards have made get the marks, too.
///
/// # Errors
/// If a shard is missing, incomplete or there twice, or if shards were graded with different inputs: says which. Nothing
/// is copied then.
pub fn merge(folders: &[PathBuf], out: &Path, rubric: &Rubric) -> Result<Outcome> {
    let files: Vec<ShardFile> =
        folders.iter().map(|folder| ShardFile::load(folder)).collect::<Result<_>>()?;
    check(folders, &files)?;
    let marks = Marks::open(out)?;
    let rules = rubric.policy.as_ref();
    let zone = rules.map_or(Ok(TimeZone::UTC), |rules| zone(&rules.time_zone)).map_err(Error::Input)?;
    let pages = PageMaker { marks: &marks, zone, path: &rubric.submission.path };
    for (folder, file) in folders.iter().zip(&files) {
        for row in &file.rows {
            ResultDir::new(folder, &row.key).copy_to(&ResultDir::new(out, &row.key))?;
        }
    }
    let mut files = files.into_iter();
    let first = files.next().ok_or_else(|| Error::Input("there are no shards".to_owned()))?;
    let place: BTreeMap<String, usize> =
        first.members.iter().enumerate().map(|(place, key)| (key.clone(), place)).collect();
    let mut outcome = Outcome {
        inputs: first.inputs().to_owned(),
        rows: first.rows,
        fingerprints: first.fingerprints,
        changes: first.changes,
        graded: first.graded,
        unchanged: first.unchanged,
        provenance: first.provenance,
        weakest_sandbox: first.weakest_sandbox,
        leaderboard: first.leaderboard,
    };
    for file in files {
        outcome.rows.extend(file.rows);
        outcome.fingerprints.extend(file.fingerprints);
        outcome.changes.extend(file.changes);
        outcome.graded += file.graded;
        outcome.unchanged += file.unchanged;
        outcome.weakest_sandbox = outcome.weakest_sandbox.into_iter().chain(file.weakest_sandbox).min();
    }
    outcome.rows.sort_by_key(|row| place.get(&row.key).copied());
    outcome.rows.iter_mut().for_each(|row| row.apply(&marks, rules));
    for row in &outcome.rows {
        let result_dir = ResultDir::new(out, &row.key);
        let has_pages = result_dir.pages().iter().any(|page| page.is_file());
        if let Some(record) = result_dir.record_alone().filter(|_| has_pages) {
            pages.make(&result_dir, &record, row);
        }
    }
    outcome.changes.sort();
    outcome.keep_one_fingerprint_of_each_team();
    Ok(outcome)
}

/// Checks that the shards are all shards of one class, graded with the same inputs.
fn check(folders: &[PathBuf], files: &[ShardFile]) -> Result<()> {
    let Some(first) = files.first() else { return Ok(()) };
    for (folder, file) in folders.iter().zip(files) {
        for ((name, one), (_, other)) in first.common().iter().zip(file.common()) {
            if *one != other {
                return Err(Error::file(
                    folder,
                    format!(
                        "{} was graded with another {name} than {}: grade it again",
                        file.shard, first.shard
                    ),
                ));
            }
        }
        if file.inputs() != first.inputs() {
            return Err(Error::file(
                folder,
                format!(
                    "{} was graded with another solution, another --only or other sources of the grader than {}: grade \
                     it again",
                    file.shard, first.shard
                ),
            ));
        }
    }
    let count = first.shard.count;
    let mut seen: BTreeSet<u32> = BTreeSet::new();
    for (folder, file) in folders.iter().zip(files) {
        if !seen.insert(file.shard.index) {
            return Err(Error::file(folder, format!("{} is there twice", file.shard)));
        }
    }
    let missing: Vec<String> =
        (1..=count).filter(|index| !seen.contains(index)).map(|index| index.to_string()).collect();
    if !missing.is_empty() {
        let missing = missing.join(", ");
        return Err(Error::Input(format!(
            "of {count} shards, these are missing: {missing} (--shard={missing}/{count})"
        )));
    }
    let rows: BTreeSet<&str> = files.iter().flat_map(|file| &file.rows).map(|row| row.key.as_str()).collect();
    match first.members.iter().find(|key| !rows.contains(key.as_str())) {
        Some(key) => Err(Error::Harness(format!("no shard has a row of {key}"))),
        None => Ok(()),
    }
}

impl ResultDir {
    /// Copies the results to another folder, and replaces those that are there. Leaves nothing half copied behind.
    fn copy_to(&self, to: &Self) -> Result<()> {
        let (from, to) = (self.path(), to.path());
        if !from.is_dir() {
            return Ok(());
        }
        let parent = to.parent().unwrap_or(to);
        output::create_folder(parent)?;
        let name = to.file_name().unwrap_or_default().to_string_lossy();
        let aside = parent.join(format!(".{name}.part"));
        let trouble = |error: std::io::Error| Error::output(to, error);
        remove_folder(&aside).map_err(trouble)?;
        std::fs::create_dir(&aside).map_err(trouble)?;
        for entry in std::fs::read_dir(from).map_err(trouble)? {
            let path = entry.map_err(trouble)?.path();
            if path.is_file() {
                std::fs::copy(&path, aside.join(path.file_name().unwrap_or_default())).map_err(trouble)?;
            }
        }
        remove_folder(to).map_err(trouble)?;
        std::fs::rename(&aside, to).map_err(trouble)
    }
}

fn remove_folder(path: &Path) -> std::io::Result<()> {
    match std::fs::remove_dir_all(path) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => Err(error),
        _ => Ok(()),
    }
}
