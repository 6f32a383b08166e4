//! What a grade does after its points are known: convergence, pictures, and the report as pages.

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
use present::streams::{note, print_line};
use verdict::error::Result;
use verdict::pictures::Picture;
use verdict::report::Report;

/// Adds convergence and pictures of a program to its report, saves the report again, and writes it as pages beside
/// `file`. Without a program (nothing compiled), only the pages are written. Points do not change.
///
/// # Errors
/// If the harness fails, or a file cannot be written.
pub(super) fn complete(
    workspace: &Workspace,
    grader: &Grader,
    program: Option<&SubmissionProgram>,
    report: &mut Report,
    file: &Path,
) -> Result<()> {
    let mut shown = Vec::new();
    if let Some(program) = program {
        note("measuring error against run time, which gives no points (--no-report skips it) …");
        let (seed, Options { threads, .. }) = (grader.public_seed(), grader.options());
        let solution = grader.oracle().map(Oracle::program).transpose()?;
        let convergence = brief(workspace, grader.rubric(), program, solution.as_deref(), seed)?;
        print_line("\nError against run time (gives no points)")?;
        print_sentences(&convergence);
        report.convergence = Some(convergence);
        shown = pictures(workspace, grader.rubric(), program, report, *threads, seed, MAX_PICTURES)?;
        report.images = shown.iter().flat_map(Picture::errors).collect();
    }
    report.save(file)?;
    save(&shown, &pictures_beside(file))?;
    // Students have no solution, and only need their own edition.
    let is_staff = workspace.is_staff();
    let readers = if is_staff { Readers::Staff(None) } else { Readers::Student };
    write_pages(report, &shown, file, readers)?;
    let [student, tutor] = pages_beside(file);
    note(format_args!("page: {}", if is_staff { tutor } else { student }.display()));
    Ok(())
}
