//! What a grade does once its points stand: error against run time, pictures, and the report as a page.

use std::path::Path;

use harness::build::SubmissionProgram;
use harness::workspace::Workspace;
use judge::convergence::brief;
use judge::grade::{Grader, Options};
use judge::pictures::{MAX_PICTURES, pictures};
use judge::reference::Oracle;
use present::convergence::print_sentences;
use present::page::{Readers, pages_beside, pictures_beside, write_pages};
use present::pictures::save;
use verdict::error::Result;
use verdict::pictures::Picture;
use verdict::report::Report;

/// Completes the report on a program, saves it again, and writes it as pages beside it. The points do not change.
pub(super) fn complete(
    workspace: &Workspace,
    grader: &Grader,
    program: Option<&SubmissionProgram>,
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
        shown = pictures(workspace, program, report, *threads, *seed, MAX_PICTURES)?;
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
