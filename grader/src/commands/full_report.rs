//! What a grade does once its points stand: error against run time, pictures, and the report as a page.

use std::path::Path;

use crate::build::HandInProgram;
use crate::convergence::{brief, print_sentences};
use crate::error::Result;
use crate::grade::{Grader, Options};
use crate::reference::Oracle;
use crate::report::pictures::{MOST, pictures, save};
use crate::report::{Picture, Readers, Report, pages_beside, pictures_beside, write_pages};
use crate::workspace::Workspace;

/// Completes the report on a program, saves it again, and writes it as pages beside it. The points do not change.
pub(super) fn complete(
    workspace: &Workspace,
    grader: &Grader,
    program: Option<&HandInProgram>,
    report: &mut Report,
    file: &Path,
) -> Result<()> {
    let mut shown = Vec::new();
    if let Some(program) = program {
        eprintln!("measuring error against run time, for no points (--no-report leaves it out) …");
        let Options { seed, threads, .. } = grader.options();
        let solution = grader.oracle().map(Oracle::program).transpose()?;
        let convergence = brief(workspace, program, solution.as_deref(), *seed)?;
        println!("\nError against run time, for no points");
        print_sentences(&convergence);
        report.convergence = Some(convergence);
        shown = pictures(workspace, program, report, *threads, *seed, MOST)?;
        report.images = shown.iter().flat_map(Picture::errors).collect();
    }
    report.save(file)?;
    save(&shown, &pictures_beside(file))?;
    // Students have no solution, and nobody to write the other edition for.
    let staff = workspace.solution_file().is_file();
    let readers = if staff { Readers::Staff(None) } else { Readers::Student };
    write_pages(report, &shown, file, readers)?;
    let [student, tutor] = pages_beside(file);
    eprintln!("page: {}", if staff { tutor } else { student }.display());
    Ok(())
}
