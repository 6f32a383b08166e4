//! `cargo lab facts` and `cargo lab leave-one-out`.

use std::process::ExitCode;

use crate::facts::{LearntFacts, leave_one_out, measure};
use crate::mutants::{Kind, variants};
use crate::output::{print, write_text};
use harness::assignment::{Assignment, AssignmentOption};
use harness::workspace::Workspace;
use judge::diagnosis::Catalogue;
use verdict::error::{Error, Result};

/// Measure the facts of all variants, and learn which facts fail for which known mistake
///
/// Writes facts.json of the assignment. Exit status 1 if a fact fails for a correct variant.
#[derive(clap::Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    assignment: AssignmentOption,
    /// Seed of the random numbers
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Measure only these variants and print their failed facts, without writing a file; repeatable
    #[arg(long, value_name = "VARIANT")]
    only: Vec<String>,
}

/// Diagnose each known mistake as if nobody had seen it, by facts alone
///
/// Reads facts.json of the assignment, which `cargo lab facts` makes, and writes variants/leave-one-out.md there.
#[derive(clap::Args)]
pub(super) struct LeaveOneOut {
    #[command(flatten)]
    assignment: AssignmentOption,
}

pub(super) fn run(arguments: &Arguments) -> Result<ExitCode> {
    let workspace = Workspace::find()?;
    let assignment = audited(&arguments.assignment, &workspace)?;
    let mut list = variants(&assignment)?.list;
    let all = arguments.only.is_empty();
    list.retain(|variant| all || arguments.only.contains(&variant.id));
    let learnt = measure(&assignment.framework(&workspace)?, &list, arguments.seed)?;
    let mut wrong = 0;
    for variant in &list {
        let Some(row) = learnt.row(&variant.id) else { continue };
        wrong += usize::from(variant.kind == Kind::Right && !row.failed.is_empty());
        if !all || (variant.kind == Kind::Right && !row.failed.is_empty()) {
            let names: Vec<&str> = row.failed.iter().map(|failed| failed.0.as_str()).collect();
            print(&format!("{}: {}\n", variant.id, names.join(" ")))?;
        }
    }
    if all {
        let made_by = format!("cargo lab facts --seed={}", arguments.seed);
        let file = assignment.folder.facts_file();
        learnt.save(&file, &made_by)?;
        eprintln!("facts: {}", file.display());
    }
    print(&format!("correct variants with a failed fact: {wrong}\n"))?;
    Ok(ExitCode::from(u8::from(wrong > 0)))
}

pub(super) fn run_leave_one_out(arguments: &LeaveOneOut) -> Result<ExitCode> {
    let workspace = Workspace::find()?;
    let assignment = audited(&arguments.assignment, &workspace)?;
    let folder = &assignment.folder;
    let learnt = LearntFacts::load(&folder.facts_file())?;
    let variants = variants(&assignment)?.list;
    let table = leave_one_out(&Catalogue::load(folder, &assignment.rubric)?, &learnt, &variants);
    let file = folder.leave_one_out_table();
    write_text(&file, &table)?;
    eprintln!("table: {}", file.display());
    print(table.lines().take(12).collect::<Vec<_>>().join("\n").as_str())?;
    Ok(ExitCode::SUCCESS)
}

/// The assignment, whose submissions have facts.
fn audited(option: &AssignmentOption, workspace: &Workspace) -> Result<Assignment> {
    let assignment = option.open(workspace)?;
    if assignment.rubric.is_audited() {
        return Ok(assignment);
    }
    Err(Error::Input(format!(
        "{}: none of its checks is about light samples, which facts are about; mistakes are known by their signatures \
         (`cargo lab signatures`)",
        assignment.name
    )))
}
