//! `cargo lab compare`.

use std::path::PathBuf;
use std::process::ExitCode;

use crate::compare::{Comparison, Grades};
use crate::output::print;
use verdict::error::Result;

/// Compare two sets of grades, and print every verdict and task score that differs
///
/// A set is a folder written by `cargo lab mutants --out`, or one with a subfolder per submission that holds its report.json.
/// Reports of the formats arty-report/1 and arty-report/2 can be compared. Submissions match by name; a leading number
/// such as in 45-one-sample-mis is ignored.
///
/// Exit status 1 if anything differs, or if AFTER lacks a submission of BEFORE. Submissions that exist only in AFTER are
/// listed, but do not count as a difference.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Folder with the earlier grades
    before: PathBuf,
    /// Folder with the later grades
    after: PathBuf,
    /// A submission that has another name in AFTER; repeatable
    #[arg(long, value_name = "OLD=NEW", value_parser = renamed)]
    renamed: Vec<(String, String)>,
}

pub(super) fn run(arguments: &Arguments) -> Result<ExitCode> {
    let (before, after) = (Grades::load(&arguments.before)?, Grades::load(&arguments.after)?);
    let comparison = Comparison::new(&before, &after, &arguments.renamed.iter().cloned().collect());
    print(&comparison.to_string())?;
    Ok(ExitCode::from(u8::from(!comparison.is_same())))
}

fn renamed(text: &str) -> std::result::Result<(String, String), String> {
    let (old, new) = text.split_once('=').ok_or("expected OLD=NEW")?;
    Ok((old.to_owned(), new.to_owned()))
}
