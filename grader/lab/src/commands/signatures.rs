//! `cargo lab signatures`.

use std::path::PathBuf;
use std::process::ExitCode;

use crate::mutants::{Ledger, learn, variants};
use crate::output::{print, write_text};
use harness::assignment::AssignmentOption;
use harness::workspace::Workspace;
use judge::diagnosis::Catalogue;
use verdict::error::Result;

/// Learn signatures of known mistakes from the grades of `cargo lab mutants`, and measure how often a cause is named
/// correctly
///
/// The grades of one seed become signatures.json of the assignment. The grades of all other seeds are diagnosed with
/// these signatures; the result is written to its variants/confusion.md and confusion.json.
#[derive(clap::Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    assignment: AssignmentOption,
    /// Seed whose grades become signatures
    #[arg(long, value_name = "SEED", default_value_t = 1)]
    learn: u64,
    /// Folder with the grades [default: target/mutants]
    #[arg(long, value_name = "DIR")]
    grades: Option<PathBuf>,
}

pub(super) fn run(arguments: &Arguments) -> Result<ExitCode> {
    let workspace = Workspace::find()?;
    let assignment = arguments.assignment.open(&workspace)?;
    let (folder, rubric) = (&assignment.folder, &assignment.rubric);
    let grades = arguments.grades.clone().unwrap_or_else(|| workspace.root().join("target/mutants"));
    let ledger = Ledger::open(&grades, &workspace, &assignment.name)?;
    let learnt = learn(&ledger, &variants(&assignment)?.list, rubric, arguments.learn)?;

    let made_by = format!("cargo lab signatures --learn={}", arguments.learn);
    let signatures = folder.signatures_file();
    let table = folder.confusion_table();
    learnt.signatures.save(&signatures, &made_by)?;
    learnt.cases.save(&folder.confusion_data(), &made_by)?;
    let (confusion, early) = learnt.confusion(&Catalogue::load(folder, rubric)?, rubric);
    write_text(&table, &confusion.table(&made_by, &early))?;

    eprintln!("signatures: {}", signatures.display());
    eprintln!("confusion matrix: {}", table.display());
    let ([wrong, first, named], [right, blamed]) = (confusion.wrong(), confusion.right());
    print(&format!(
        "right cause named first: {first} of {wrong}; named at all: {named} of {wrong}\n\
         correct submissions with a named cause: {blamed} of {right}\n"
    ))?;
    Ok(ExitCode::SUCCESS)
}
