//! `cargo lab compare`.

use std::path::PathBuf;
use std::process::ExitCode;

use crate::compare::{Comparison, Grades};
use crate::output::print;
use verdict::error::Result;

/// Compare two sets of grades, and print every verdict and every task's points that differ
///
/// A set is a folder that `cargo lab mutants --out` has written, or a folder with folders that each hold a report.json.
/// Reports of the formats arty-report/1 and arty-report/2 can be compared. Submissions match by name; a leading number
/// such as in 45-one-sample-mis is ignored.
///
/// Exit status 1 if anything differs, or AFTER lacks a submission of BEFORE. Submissions that only AFTER has are listed,
/// and do not count as a difference.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Folder of the earlier grades
    before: PathBuf,
    /// Folder of the later grades
    after: PathBuf,
    /// A submission that has another name in AFTER; may be repeated
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
