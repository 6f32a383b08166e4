//! `grader similar`.

use std::path::PathBuf;
use std::process::ExitCode;

use classroom::class::gradebook::load_rows;
use classroom::class::similar::{Archive, Earlier, Starter, describe, export, groups, page};
use harness::assignment::AssignmentOption;
use harness::workspace::Workspace;
use present::streams::{note, print};
use present::words::count;
use verdict::error::Result;

/// Compare the submissions of a graded class with each other and with those of earlier years
///
/// Writes similar.html: similar sources side by side.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Results of an earlier year, or their fingerprints.json; only read; repeatable
    #[arg(long, value_name = "DIR|FILE")]
    earlier: Vec<PathBuf>,
    /// Also write the sources into a new folder, in the layout that JPlag and Dolos read
    #[arg(long, value_name = "DIR")]
    export: Option<PathBuf>,
    #[command(flatten)]
    assignment: AssignmentOption,
    /// Folder with the results of the class
    #[arg(long, value_name = "DIR", default_value = "class-report")]
    out: PathBuf,
}

pub(super) fn run(arguments: &Arguments, workspace: &Workspace) -> Result<ExitCode> {
    let assignment = arguments.assignment.open(workspace)?;
    let (name, out) = (&assignment.rubric.assignment, &arguments.out);
    let starter = assignment.folder.starter()?;
    let own = Archive::load(out, name)?;
    let earlier = Earlier::load(&arguments.earlier, name)?;
    let groups = groups(&own.fingerprints, &earlier.fingerprints);
    let file = out.join("similar.html");
    page::save(&file, out, &Starter::new(&starter), &groups, &earlier)?;
    print(describe(&groups))?;
    note(format_args!("page: {}", file.display()));
    if let Some(folder) = &arguments.export {
        let sources = export::save(folder, out, &load_rows(&out.join("class.json"))?, &starter)?;
        note(format_args!("{}: {}; in that folder:", folder.display(), count(sources, "source")));
        note("  java -jar jplag.jar -l rust -bc base submissions");
        note("  dolos run -l rust -i base/starter.rs info.csv");
    }
    Ok(ExitCode::SUCCESS)
}
