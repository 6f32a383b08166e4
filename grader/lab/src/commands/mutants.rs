//! `cargo lab mutants`.

use std::path::PathBuf;
use std::process::ExitCode;

use indicatif::ProgressBar;

use crate::mutants::{Ledger, Outcome, Record, Variant, table, variants};
use crate::output::{print, write_text};
use harness::assignment::AssignmentOption;
use harness::sandbox::Limits;
use harness::workspace::Workspace;
use judge::grade::Options;
use verdict::error::{Error, Result};

/// Grade wrong and correct variants of the solution, and report which mistakes are caught
///
/// Exit status 1 if the outcome of any variant is unexpected.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Grade only these variants, selected by name, by row of the catalogue, or as `right` or `wrong`
    #[arg(long, value_name = "VARIANT|ROW|KIND")]
    only: Vec<String>,
    /// Grade each variant with seeds 1 to N
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..))]
    seeds: u64,
    #[command(flatten)]
    assignment: AssignmentOption,
    /// Folder for the results; existing results are reused [default: target/mutants]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Number of variants to grade at once, each with one thread [default: one per core]
    #[arg(long, value_name = "N")]
    jobs: Option<usize>,
}

pub(super) fn run(arguments: &Arguments) -> Result<ExitCode> {
    let workspace = Workspace::find()?;
    let assignment = arguments.assignment.open(&workspace)?;
    let all = variants(&assignment)?;
    let selected: Vec<&Variant> =
        all.list.iter().filter(|variant| is_selected(variant, &arguments.only)).collect();
    if selected.is_empty() {
        return Err(Error::Input("--only: there is no such variant, row or kind".to_owned()));
    }
    let folder = arguments.out.clone().unwrap_or_else(|| workspace.root().join("target/mutants"));
    let mut ledger = Ledger::open(&folder, &workspace, &assignment.name)?;
    let threads = arguments.jobs.unwrap_or_else(rayon::current_num_threads).max(1);

    let bar = ProgressBar::new(arguments.seeds * selected.len() as u64);
    for seed in 1..=arguments.seeds {
        let name = assignment.name.clone();
        let options =
            Options { assignment: name, seed, threads, only: Vec::new(), limits: Limits::default() };
        ledger.grade(&workspace, &selected, &options, || false, |_| bar.inc(1))?;
    }
    bar.finish_and_clear();
    let mut unexpected = 0;
    for variant in &selected {
        let records = ledger.records(variant);
        let outcome = Outcome::new(variant, &records);
        unexpected += usize::from(!outcome.unexpected.is_empty());
        print(&describe(variant, &records, &outcome))?;
    }

    let records: Vec<Vec<&Record>> = all.list.iter().map(|variant| ledger.records(variant)).collect();
    // Only a complete matrix replaces the committed one.
    let is_complete = records.iter().all(|records| !records.is_empty());
    let file = if is_complete { assignment.folder.kill_matrix() } else { folder.join("kill-matrix.md") };
    write_text(&file, &table(&all, &assignment.rubric, &records))?;
    eprintln!("kill matrix: {}", file.display());
    print(&format!("{unexpected} of {} variants have an unexpected outcome\n", selected.len()))?;
    Ok(ExitCode::from(u8::from(unexpected > 0)))
}

fn is_selected(variant: &Variant, only: &[String]) -> bool {
    only.is_empty()
        || only
            .iter()
            .any(|name| *name == variant.id || name == variant.kind.name() || variant.rows.contains(name))
}

fn describe(variant: &Variant, records: &[&Record], outcome: &Outcome) -> String {
    let mut text = format!("{:<45} {:<24}", variant.id, outcome.word(variant.kind));
    for record in records {
        let points: Vec<String> =
            record.tasks.iter().map(|(task, [earned, worth])| format!("{task} {earned}/{worth}")).collect();
        text += &format!("  [{}: {}, {:.1} s]", record.seed, points.join(" "), record.seconds);
    }
    for message in &outcome.unexpected {
        text += &format!("\n    UNEXPECTED: {message}");
    }
    text + "\n"
}
