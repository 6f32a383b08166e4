//! `cargo lab signatures`.

use std::path::PathBuf;
use std::process::ExitCode;

use crate::mutants::{Kind, Ledger, Variant, variants};
use harness::assignment::Assignment;
use harness::workspace::Workspace;
use judge::diagnosis::{Catalogue, Confusion, Signatures, Vector};
use verdict::error::{Error, Result};

/// Measure how known mistakes look, and how often they are named, from what `cargo lab mutants` has graded (for staff).
///
/// The grades of one seed become the signatures (signatures.json of the assignment); those of all other seeds are
/// diagnosed with them, and what comes out is written to grader/variants/confusion.md and confusion.json.
#[derive(clap::Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    assignment: Assignment,
    /// The seed whose grades become the signatures
    #[arg(long, value_name = "SEED", default_value_t = 1)]
    learn: u64,
    /// Folder of the grades [default: target/mutants]
    #[arg(long, value_name = "DIR")]
    grades: Option<PathBuf>,
}

/// Grades that stop early are looked at with so many checks in each task that do not pass.
const EARLY: [usize; 3] = [1, 2, 4];

pub(super) fn run(arguments: &Arguments) -> Result<ExitCode> {
    let workspace = Workspace::find()?;
    let rubric = arguments.assignment.rubric(&workspace)?;
    let all = variants(&workspace, &rubric)?;
    let folder = arguments.grades.clone().unwrap_or_else(|| workspace.root().join("target/mutants"));
    let ledger = Ledger::open(&folder, &workspace, &arguments.assignment.name)?;
    let (mut learnt, mut others) = (Signatures::default(), Signatures::default());
    for variant in &all.list {
        for (seed, vector) in graded(&ledger, variant)? {
            if seed == arguments.learn && variant.kind == Kind::Wrong {
                learnt.insert(&variant.id, seed, vector);
            } else if seed != arguments.learn || variant.kind == Kind::Right {
                others.insert(&variant.id, seed, vector);
            }
        }
    }
    let missing: Vec<&str> = all
        .list
        .iter()
        .filter(|variant| variant.kind == Kind::Wrong && learnt.get(&variant.id).is_none())
        .map(|variant| variant.id.as_str())
        .collect();
    if !missing.is_empty() {
        return Err(Error::Input(format!(
            "with seed {} these were not graded as they are now: {}\nrun `cargo lab mutants --seeds=3` first",
            arguments.learn,
            missing.join(", ")
        )));
    }
    let folder = workspace.assignment(&arguments.assignment.name);
    let made_by = format!("cargo lab signatures --learn={}", arguments.learn);
    learnt.save(&Catalogue::signatures_file(&folder), &made_by)?;
    let file = workspace.variants().join("confusion.md");
    others.save(&file.with_extension("json"), &made_by)?;
    let catalogue = Catalogue::load(&folder)?;
    let mut confusion = Confusion::default();
    for (variant, seed, vector) in others.all() {
        confusion.add(&catalogue, variant, seed, vector);
    }
    let order: Vec<(String, String)> =
        rubric.checks().map(|(task, spec)| (task.id.clone(), spec.id())).collect();
    let early = EARLY.map(|failures| {
        let mut stopped = Confusion::default();
        for (variant, seed, vector) in others.all() {
            stopped.add(&catalogue, variant, seed, &vector.stopped_after(&order, failures));
        }
        (failures, stopped)
    });
    let text = confusion.table(&made_by, &early);
    arty::image::write_aside(&file, |writer| std::io::Write::write_all(writer, text.as_bytes()))?;
    eprintln!("signatures: {}", Catalogue::signatures_file(&folder).display());
    eprintln!("confusion matrix: {}", file.display());
    let ([wrong, first, named], [right, blamed]) = (confusion.wrong(), confusion.right());
    println!("right cause first: {first} of {wrong}; among those named: {named} of {wrong}");
    println!("correct submissions for which a cause is named: {blamed} of {right}");
    Ok(ExitCode::SUCCESS)
}

/// The grades of a variant as it is now: seed and vector.
fn graded(ledger: &Ledger, variant: &Variant) -> Result<Vec<(u64, Vector)>> {
    let records = ledger.records(variant);
    records.into_iter().map(|record| Ok((record.seed, Vector::of(&ledger.report(record)?)))).collect()
}
